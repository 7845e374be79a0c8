// Directions after a collision, for random walks.

// 1 - cos of a scattering angle of [HenyeyGreenstein1941] by inversion, s uniform in [-1, 1]. Written without
// differences of near numbers, for g near 0 and near 1.
float henyeyGreensteinVersine(float g, float s) {
    float p = 1.0 + g * s;
    float q = 1.0 - g;
    return min(0.5 * q * q * (1.0 - s) * (1.0 + g + p) / (p * p), 2.0);
}

// The unit vector `from` turned by the angle whose 1 - cos is `versine`, towards the azimuth of that cosine and sine in
// the frame of [Duff2017]. One Newton step holds the length at 1: unmended, the rounding of thousands of turns would
// add up.
vec3 turnedDirection(vec3 from, float versine, float cos_azimuth, float sin_azimuth) {
    float sine = sqrt(versine * (2.0 - versine));
    float a = sine * cos_azimuth;
    float b = sine * sin_azimuth;
    float c = 1.0 - versine;
    float side = from.z < 0.0 ? -1.0 : 1.0;
    float k = -1.0 / (side + from.z);
    float xyk = from.x * from.y * k;
    vec3 to = c * from + a * vec3(1.0 + side * from.x * from.x * k, side * xyk, -side * from.x) +
              b * vec3(xyk, side + from.y * from.y * k, -from.y);
    return (1.5 - 0.5 * dot(to, to)) * to;
}
