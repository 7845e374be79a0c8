// Reflection at a smooth dielectric surface, for unpolarised light, and its moments over the hemisphere.
//
// Everywhere `eta` is the refractive index on the side the light comes from, over the index on the other side. So
// eta > 1 is light inside a denser medium, with total reflection, and IOR itself is the argument for light inside a
// medium of relative index IOR; 1 / IOR is the argument for light outside it.

// Reflectance at cosine mu >= 0 of the angle of incidence; 1 beyond the critical angle.
float fresnelReflectance(float mu, float eta) {
    float sin2_t = eta * eta * (1.0 - mu * mu);
    if (sin2_t >= 1.0) return 1.0;
    float mu_t = sqrt(1.0 - sin2_t);
    float r_s = (eta * mu - mu_t) / (eta * mu + mu_t);
    float r_p = (mu - eta * mu_t) / (mu + eta * mu_t);
    return 0.5 * (r_s * r_s + r_p * r_p);
}

// 1 - fresnelReflectance, from the cosines on both sides, without the rounding of small ones.
float fresnelTransmittance(float mu, float mu_t, float eta) {
    float product = mu * mu_t;
    if (product <= 0.0) return 0.0;
    float s = eta * mu + mu_t;
    float p = mu + eta * mu_t;
    return 2.0 * eta * product * (1.0 / (s * s) + 1.0 / (p * p));
}

// Gauss-Legendre with 16 points on [-1, 1]: the positive half.
const float gauss_node[8] = float[8](0.0950125098376374402, 0.281603550779258913, 0.458016777657227386,
                                     0.617876244402643748, 0.755404408355003034, 0.865631202387831744,
                                     0.944575023073232576, 0.989400934991649933);
const float gauss_weight[8] = float[8](0.189450610455068496, 0.182603415044923589, 0.169156519395002538,
                                       0.149595988816576732, 0.124628971255533872, 0.0951585116824927848,
                                       0.0622535239386478929, 0.0271524594117540949);

// C_k(eta) = integral of fresnelReflectance(mu, eta) mu^k over mu in [0, 1], for k = 1 or 2 and eta in [1/4, 4]:
// [dEonIrving2011] appendix, to 1e-12 in double; exactly 0 at eta = 1.
//
// Snell's law n^2 inner^2 - outer^2 = n^2 - 1 between the two cosines is a hyperbola. With n inner = c cosh(t) and
// outer = c sinh(t) both amplitudes are rational in w = exp(-2 t): r_s = -w, r_p = (b - w) / (1 - b w). The integrand
// is then smooth from grazing (t = 0) to normal incidence (t_max).
float fresnelMoment(int k, float eta) {
    if (eta == 1.0) return 0.0;
    bool inside = eta > 1.0;
    float n = max(eta, 1.0 / eta);
    float c = sqrt((n - 1.0) * (n + 1.0));
    float b = (n * n - 1.0) / (n * n + 1.0);
    float t_max = 0.5 * log((n + 1.0) / (n - 1.0));
    float sum = 0.0;
    for (int i = 0; i < 16; i++) {
        float x = i < 8 ? -gauss_node[i] : gauss_node[i - 8];
        float weight = i < 8 ? gauss_weight[i] : gauss_weight[i - 8];
        float t = 0.5 * t_max * (1.0 + x);
        float w = exp(-2.0 * t);
        float r_p = (b - w) / (1.0 - b * w);
        float inner = c * cosh(t) / n;
        float outer = c * sinh(t);
        float mu = inside ? inner : outer;
        float dmu_dt = inside ? outer / n : inner * n;
        sum += weight * 0.5 * (w * w + r_p * r_p) * (k == 1 ? mu : mu * mu) * dmu_dt;
    }
    // Inside, everything below the critical cosine c / n is reflected.
    float total_reflection = inside ? (k == 1 ? c * c / (2.0 * n * n) : c * c * c / (3.0 * n * n * n)) : 0.0;
    return 0.5 * t_max * sum + total_reflection;
}

// The same moments by the polynomials of [dEonIrving2011], which fit 2 C_1 and 3 C_2 to about 2e-3 and 5e-3 for eta in
// [0.4, 2.5] and nothing beyond it. They do not vanish at eta = 1, where there is no reflection; there 0 is returned. Those
// for eta > 1 are rearranged about 1.4: as printed, terms of up to 2000 cancel, which single precision does not bear.
float fresnelMomentPublished(int k, float eta) {
    if (eta == 1.0) return 0.0;
    float e = eta;
    float x = eta - 1.4;
    if (k == 1) {
        return 0.5 * (e < 1.0 ? 0.919317 + e * (-3.4793 + e * (6.75335 + e * (-7.80989 + e * (4.98554 - e * 1.36881))))
                              : 0.52988495712 + x * (0.746411944 + x * (-0.88913688 + x * (0.9792188 +
                                                x * (-0.759569 + x * 0.254913)))));
    }
    float series = e < 1.0 ? 0.828421 + e * (-2.62051 + e * (3.36231 + e * (-1.95284 + e * (0.236494 + e * 0.145787))))
                           : (1.0601361913856 + x * (4.530555455232 + x * (4.72717934208 + x * (0.8672954944 +
                              x * (-0.13599088 + x * (-1.55029136 + x * (5.2947288 + x * (-5.533588 +
                              x * 1.91826)))))))) / (e * e * e);
    return series / 3.0;
}

// 2 C_1, the reflectance for diffuse light, by the fits of [EganHilgeman1979]: to 2e-3 for eta in [0.5, 2]; 0 at eta = 1.
float fresnelDiffusePublished(float eta) {
    if (eta == 1.0) return 0.0;
    return eta > 1.0 ? -1.440 / (eta * eta) + 0.710 / eta + 0.668 + 0.0636 * eta
                     : -0.4399 + (0.7099 + (-0.3319 + 0.0636 / eta) / eta) / eta;
}

// C_phi and C_E, the weights of fluence and flux in the exitance, from C_1 and C_2: [Frisvad2014] Eqs. 30 and 31.
float fluenceWeight(float c1) { return 0.25 * (1.0 - 2.0 * c1); }
float fluxWeight(float c2) { return 0.5 * (1.0 - 3.0 * c2); }

// A: how much the inner reflection moves the extrapolated boundary outwards, [Frisvad2014] Eq. 22; 1 at eta = 1.
float reflectionParameter(float c1, float c2) { return (1.0 + 3.0 * c2) / (1.0 - 2.0 * c1); }
