// Diffusion theory: coefficients, and the point source without cancellation.

// Diffusion coefficient D of the classical theory, mm. sigma_tp is the reduced extinction sigma_a + (1 - g) sigma_s.
vec3 classicalDiffusion(vec3 sigma_tp) { return 1.0 / (3.0 * sigma_tp); }

// D of [Grosjean1956], mm: (2 sigma_a + sigma_s') / (3 sigma_t'^2); holds at low albedo, too.
vec3 grosjeanDiffusion(vec3 sigma_a, vec3 sigma_tp) { return (sigma_a + sigma_tp) / (3.0 * sigma_tp * sigma_tp); }

// (1 - exp(-x)) / x for x >= 0, to rounding; 1 at x = 0. It is the mean of exp(-x t) over t in [0, 1].
float decayMean(float x) {
    if (x > 1.0) return (1.0 - exp(-x)) / x;
    // exp(-x/2) sinh(x/2) / (x/2), with the series of the quotient up to (x/2)^14 / 15!.
    float h2 = 0.25 * x * x;
    float series = 1.0 + h2 / 210.0;
    series = 1.0 + h2 / 156.0 * series;
    series = 1.0 + h2 / 110.0 * series;
    series = 1.0 + h2 / 72.0 * series;
    series = 1.0 + h2 / 42.0 * series;
    series = 1.0 + h2 / 20.0 * series;
    series = 1.0 + h2 / 6.0 * series;
    return exp(-0.5 * x) * series;
}
vec3 decayMean(vec3 x) { return vec3(decayMean(x.x), decayMean(x.y), decayMean(x.z)); }

// exp(-s d) / d - exp(-s (d + gap)) / (d + gap), for gap >= 0: fluence of a source at distance d and its negative image
// at d + gap, times 4 pi D. Far away the two nearly cancel, so they are never subtracted.
vec3 sourceMinusImage(vec3 s, vec3 d, vec3 gap) {
    return exp(-s * d) * gap / (d + gap) * (1.0 / d + s * decayMean(s * gap));
}

// Mean depth of a first collision within a slab of optical thickness tau, in mean free paths: tau/2 when thin, 1 when
// thick.
float firstCollisionDepth(float tau) {
    if (tau > 0.5) return 1.0 - tau * exp(-tau) / (1.0 - exp(-tau));
    // The same by its series of Bernoulli numbers up to tau^12, 1e-15 at the seam.
    float t2 = tau * tau;
    float series = 1.0 / 47900160.0 - t2 * 5.284190138687493e-10;
    series = -1.0 / 1209600.0 + t2 * series;
    series = 1.0 / 30240.0 + t2 * series;
    series = -1.0 / 720.0 + t2 * series;
    return 0.5 * tau - t2 * (1.0 / 12.0 + t2 * series);
}
vec3 firstCollisionDepth(vec3 tau) {
    return vec3(firstCollisionDepth(tau.x), firstCollisionDepth(tau.y), firstCollisionDepth(tau.z));
}
