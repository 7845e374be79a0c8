// Light that is scattered once: the integral over where on its way that happens.

// Gauss-Legendre with 24 points x on [0, 1] under x^3 (4 - 3 x): place and weight. Flat at both ends, more so at 0.
const float scatter_place[24] = float[24](5.56382568460803e-08, 7.993276491127748e-06, 0.0001148661200910683,
    0.0007014924008923981, 0.002719082169239308, 0.007920218908961779, 0.01891422732206022, 0.03896103224780433,
    0.07148917054791508, 0.1194075435252017, 0.1843533208863986, 0.2660586164260204, 0.3620125338593562,
    0.4675411779414309, 0.5763372723694448, 0.6813644933497135, 0.7759660002655515, 0.8549468134675912,
    0.9153924781930727, 0.9570360580719639, 0.9820820448483837, 0.9945174076574295, 0.9990580942033953,
    0.999965367100075);
const float scatter_weight[24] = float[24](4.277552781234855e-07, 2.698681899972223e-05, 0.0002452378783582875,
    0.001082382819429432, 0.003243753447456339, 0.007596803787009593, 0.01494273721818925, 0.02573411885099288,
    0.03981996362335382, 0.05630063983837747, 0.07355220709542513, 0.08943864966067473, 0.1016811929422055,
    0.1083093894674692, 0.1080910329549095, 0.1008353067053179, 0.0874877657356654, 0.06998177352415798,
    0.05086807474981603, 0.03279834918358761, 0.01797625769513055, 0.00770084874604808, 0.002108769172552185,
    0.0001773303295953768);

// Exitance at x from the point of entry, per unit flux that has entered there as one beam and is scattered once:
//
//     integral of stretch sigma_s exp(-sigma_t (stretch s + d)) p(cosine) T21(mu) mu / d^2 over s >= 0,
//
// where s runs along `line` from the point of entry, stretch s is how far light has come, d is the straight way from
// there to x, mu its cosine with the normal `no` at x, and the phase function is Henyey and Greenstein's, for light that
// travelled along `travel`. line, travel and no are unit vectors, no outwards; eta is the index inside over outside.
// With line = travel and stretch = 1 this is exact: [Habel2013] section 5, for any angle and with its own normal at x.
//
// s is replaced by the angle between the way back along `line` and the way to x, seen from the point of scattering
// (equiangular, [KullaFajardo2012]): ds / d^2 = dangle / h, h being the distance from x to the line. With u = tan of
// half the angle everything is rational; with m = u / (1 + u) the range is finite. The rule for m has 24 points, and
// errs by less than 1e-5 for h from 1e-3 to 30 mean free paths and g from -0.6 to 0.99.
//
// The value grows as 1 / h. h is taken for 1e-6 mean free paths of the densest channel where it is less: at the point
// of entry it is finite, and its integral over the surface loses no more than 1e-6.
vec3 scatteredOnce(vec3 x, vec3 line, float stretch, vec3 travel, vec3 no, vec3 sigma_s, vec3 sigma_t, vec3 g,
                   float eta) {
    float densest = max(max(sigma_t.x, sigma_t.y), sigma_t.z);
    if (densest == 0.0) return vec3(0.0);
    float along = dot(x, line);
    vec3 across = x - along * line;
    float h = length(across);
    // On the line itself any direction across will do: one along the surface.
    vec3 aside = h > 0.0 ? across : cross(line, no);
    if (dot(aside, aside) == 0.0) aside = cross(line, abs(line.x) < 0.7 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0));
    aside = normalize(aside);
    h = max(h, 1e-6 / densest);

    // mu (1 + u^2) = back (1 - u^2) + 2 up u, which exceeds the critical cosine between two roots.
    float back = -dot(line, no);
    float up = dot(aside, no);
    float critical = eta > 1.0 ? sqrt(1.0 - 1.0 / (eta * eta)) : 0.0;
    float discriminant = back * back + up * up - critical * critical;
    if (discriminant <= 0.0) return vec3(0.0);
    float q = up + sqrt(discriminant);
    if (q <= 0.0) return vec3(0.0);
    float least = max(0.0, (critical - back) / q);
    float r = length(vec2(along, h));
    float most = along > 0.0 ? (r + along) / h : h / (r - along);  // s = 0
    if (back + critical > 0.0) most = min(most, q / (back + critical));
    if (most <= least) return vec3(0.0);

    float from = least / (1.0 + least);
    float range = most / (1.0 + most) - from;
    float ahead = dot(travel, line);
    float sideways = dot(travel, aside);
    vec3 one_plus_g2 = 1.0 + g * g;
    vec3 sum = vec3(0.0);
    for (int i = 0; i < 24; i++) {
        float m = from + range * scatter_place[i];
        float u = m / (1.0 - m);
        float norm = 1.0 / (1.0 + u * u);
        float mu = max(0.0, (back * (1.0 - u * u) + 2.0 * up * u) * norm);
        float cosine = (2.0 * sideways * u - ahead * (1.0 - u * u)) * norm;
        float way = stretch * along + 0.5 * h * (stretch + 1.0 + (1.0 - stretch) * u * u) / u;
        float transmitted = (1.0 - fresnelReflectance(mu, eta)) * mu;
        vec3 d = one_plus_g2 - 2.0 * cosine * g;
        sum += scatter_weight[i] * transmitted * norm / ((1.0 - m) * (1.0 - m)) * exp(-way * sigma_t) / (d * sqrt(d));
    }
    return 2.0 * range * stretch / h * inv_4pi * (1.0 - g * g) * sigma_s * sum;
}
