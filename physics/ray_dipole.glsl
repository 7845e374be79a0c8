// The dipole of ray sources of [Frisvad2014], which more than one model is made of.

// Plane normal in which the ray is mirrored: n made perpendicular to x, Eq. 23. Where x is along n any one will do.
vec3 modifiedNormal(vec3 x, vec3 n) {
    if (dot(x, x) == 0.0) return n;
    vec3 t = cross(n, x);
    if (dot(t, t) == 0.0) t = abs(x.x) > abs(x.y) ? vec3(-x.z, 0.0, x.x) : vec3(0.0, x.z, -x.y);
    return normalize(cross(x, t));
}

// d_e, Eq. 21, mm; or as it is quoted from a report that preceded the paper.
vec3 rayExtrapolation(bool as_reported, vec3 d, vec3 alpha_prime) {
    return as_reported ? 2.121 * d / alpha_prime : 2.131 * d / sqrt(alpha_prime);
}

// R_d = pi 4 C_phi(1/eta) S_d of Eq. 26 at x = x_o - x_i, with refracted ray w. The image stands at h n, lift is x.n: 0
// where n was made perpendicular to x. d, s, sigma_t: diffusion coefficient, sigma_tr, extinction (not reduced);
// d_e: extrapolation distance; weights: C_phi and C_E.
vec3 rayDipole(vec3 x, vec3 w, vec3 n, float lift, vec3 no, vec3 d, vec3 s, vec3 sigma_t, vec3 d_e, vec3 h, vec2 weights) {
    float r2 = dot(x, x);
    float mu = -dot(no, w);

    // Distances to the source, Eqs. 24 and 25, and to the image. At r = 0 under a grazing ray, and where a hollow
    // surface meets the image of its tangent plane, the model is singular; 1e-3 D and 1e-3 h keep 1/d^5 within float.
    vec3 xxw = cross(x, w);
    vec3 cos_beta = -sqrt(dot(xxw, xxw) / (r2 + d_e * d_e));
    vec3 z2 = mu > 0.0 ? d * mu * (d * mu - 2.0 * d_e * cos_beta) : 1.0 / (9.0 * sigma_t * sigma_t);
    vec3 dr2 = max(r2 + z2, 1e-6 * d * d);
    vec3 dv2 = max(r2 + h * (h - 2.0 * lift), 1e-6 * h * h);
    vec3 dr = sqrt(dr2);
    vec3 dv = sqrt(dv2);
    vec3 ur = 1.0 / dr;
    vec3 uv = 1.0 / dv;

    // Eq. 20 at distance d, times 4 pi^2 4 C_phi(1/eta), is made of these three:
    //   f = exp(-s d) / d,  g = (1 + s d) exp(-s d) / d^3,  t = (3 + 3 s d + (s d)^2) exp(-s d) / d^5.
    // Source minus image, Eq. 26, is formed from f and g differences: far away they cancel. The image is the nearer one
    // only above the tangent plane.
    vec3 gap = (h * (h - 2.0 * lift) - z2) / (dv + dr);  // dv - dr
    vec3 fv = exp(-s * dv) * uv;
    vec3 fr = exp(-s * dr) * ur;
    vec3 delta_f = sourceMinusImage(s, min(dr, dv), abs(gap)) * sign(gap);
    vec3 gv = (s + uv) * uv * fv;
    vec3 delta_g = (s + ur) * ur * delta_f + (s + ur + uv) * gap * ur * uv * fv;
    vec3 tr = (3.0 * ur * (s + ur) + s * s) * ur * ur * fr;
    vec3 tv = (3.0 * uv * (s + uv) + s * s) * uv * uv * fv;

    // Seen from the image, x.w is pv, x.n_o is qv and w.n_o is -mu - 2 wn nn.
    float p = dot(x, w);
    float q = dot(x, no);
    float wn = dot(w, n);
    float nn = dot(n, no);
    vec3 pv = p + wn * (h - 2.0 * lift);
    vec3 qv = q - h * nn;
    vec3 fluence = delta_f / d + 3.0 * (p * delta_g - wn * (h - 2.0 * lift) * gv);
    vec3 inflow = 3.0 * d * (2.0 * wn * nn * gv - mu * delta_g - p * q * tr + pv * qv * tv) - q * delta_g - nn * h * gv;
    return (weights.x * fluence - weights.y * inflow) * inv_4pi;
}
