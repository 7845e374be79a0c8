// The scaled complementary error function, which diffusion from an exponential source is made of.

// erfcx(x) = exp(x^2) erfc(x) in .x, and 1 - sqrt(pi) x erfcx(x), by which it falls short of its asymptote, in .y; both to
// rounding and without cancellation, for x >= 0. They are 2 x / pi and 2 / sqrt(pi) times the integrals over t >= 0 of
// exp(-t^2) / (x^2 + t^2) and of t^2 exp(-t^2) / (x^2 + t^2): midpoints of width h, with the residue at t = i x as in
// [HunterRegan1972], which leaves an error of exp(-pi^2 / h^2).
vec2 erfcxAndDefect(float x) {
    const float h = 0.5;
    float value = 0.0, defect = 0.0;
    for (int i = 0; i < 13; i++) {
        float t2 = (float(i) + 0.5) * (float(i) + 0.5) * h * h;
        float term = exp(-t2) / (x * x + t2);
        value += term;
        defect += t2 * term;
    }
    value *= 2.0 * h / 3.14159265358979324 * x;
    defect *= 2.0 * h / 1.77245385090551603;
    // Beyond pi / h the residue is not enclosed; there it is below 1e-16.
    if (x < 3.14159265358979324 / h) {
        float turn = 2.0 * 3.14159265358979324 / h * x;
        float residue = 2.0 * exp(x * x - turn) / (1.0 + exp(-turn));
        value += residue;
        defect -= 1.77245385090551603 * x * residue;
    }
    return vec2(value, defect);
}
