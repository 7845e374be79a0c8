// Complex numbers as (real, imaginary).

vec2 complexProduct(vec2 a, vec2 b) { return vec2(a.x * b.x - a.y * b.y, a.x * b.y + a.y * b.x); }
vec2 complexQuotient(vec2 a, vec2 b) {
    return vec2(a.x * b.x + a.y * b.y, a.y * b.x - a.x * b.y) / dot(b, b);
}
vec2 complexExp(vec2 a) { return exp(a.x) * vec2(cos(a.y), sin(a.y)); }

// The root with a real part >= 0; of a negative number the one above 0.
vec2 complexRoot(vec2 a) {
    float larger = sqrt(0.5 * (length(a) + abs(a.x)));
    if (larger == 0.0) return vec2(0.0);
    float smaller = 0.5 * a.y / larger;
    if (a.x >= 0.0) return vec2(larger, smaller);
    return a.y < 0.0 ? vec2(-smaller, -larger) : vec2(smaller, larger);
}

// decayMean(a) = (1 - exp(-a)) / a, to rounding, for a real part >= 0.
vec2 complexDecayMean(vec2 a) {
    if (dot(a, a) > 1.0) return complexQuotient(vec2(1.0, 0.0) - complexExp(-a), a);
    vec2 one = vec2(1.0, 0.0);
    vec2 h2 = 0.25 * complexProduct(a, a);
    vec2 series = one + h2 / 210.0;
    series = one + complexProduct(h2, series) / 156.0;
    series = one + complexProduct(h2, series) / 110.0;
    series = one + complexProduct(h2, series) / 72.0;
    series = one + complexProduct(h2, series) / 42.0;
    series = one + complexProduct(h2, series) / 20.0;
    series = one + complexProduct(h2, series) / 6.0;
    return complexProduct(complexExp(-0.5 * a), series);
}
