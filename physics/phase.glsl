// Phase functions, 1/sr, normalised over the sphere.

const float inv_4pi = 0.0795774715459476679;

// [HenyeyGreenstein1941]: `mu` is the cosine between the directions of travel before and after; its mean is g.
float henyeyGreenstein(float mu, float g) {
    float d = 1.0 + g * g - 2.0 * g * mu;
    return inv_4pi * (1.0 - g * g) / (d * sqrt(d));
}
