// The modified Bessel function of diffusion in the plane.

// exp(-(0.4 j)^2), j = 1 to 15.
const float bessel_weight[15] =
    float[15](0.852143788966211, 0.5272924240430486, 0.23692775868212176, 0.07730474044329974, 0.01831563888873418,
              0.0031511115984444414, 0.0003936690406550759, 3.571284964163521e-05, 2.3525752000097707e-06,
              1.1253517471925912e-07, 3.908938434264861e-09, 9.859505575991508e-11, 1.8058314375132175e-12,
              2.4017347816209627e-14, 2.319522830243569e-16);

// K_0(x) for x >= 2, to 1e-12: 2 exp(-x) / sqrt(x) times the integral of exp(-w^2) / sqrt(2 + w^2 / x) over w > 0, by the
// trapezoidal rule, which converges exponentially.
float besselK0(float x) {
    float sum = 0.35355339059327376;  // 1 / (2 sqrt(2))
    for (int j = 0; j < 15; j++) {
        float w = 0.4 * float(j + 1);
        sum += bessel_weight[j] * inversesqrt(2.0 + w * w / x);
    }
    return 0.8 * exp(-x) * inversesqrt(x) * sum;
}
vec3 besselK0(vec3 x) { return vec3(besselK0(x.x), besselK0(x.y), besselK0(x.z)); }
