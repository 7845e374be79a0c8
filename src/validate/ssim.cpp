#include "validate/ssim.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/vec.h"

namespace searchlight {

namespace {

PixelPlane perceived(const Image& image, double factor) {
    PixelPlane plane(image.width, image.height);
    for (std::size_t i = 0; i < plane.values.size(); ++i) {
        const Rgba& p = image.pixels[i];
        plane.values[i] = static_cast<float>(pu21(factor * luminance(Rgb{p.r, p.g, p.b})));
    }
    return plane;
}

PixelPlane product(const PixelPlane& a, const PixelPlane& b) {
    PixelPlane plane(a.width, a.height);
    for (std::size_t i = 0; i < plane.values.size(); ++i) plane.values[i] = a.values[i] * b.values[i];
    return plane;
}

// Sum 1.
std::vector<float> window() {
    std::vector<float> weights;
    double total = 0;
    for (int x = -5; x <= 5; ++x) total += std::exp(-x * x / (2 * 1.5 * 1.5));
    for (int x = -5; x <= 5; ++x) weights.push_back(static_cast<float>(std::exp(-x * x / (2 * 1.5 * 1.5)) / total));
    return weights;
}

}  // namespace

double pu21(double luminance) {
    constexpr std::array<double, 7> p{0.353487901,   0.3734658629, 8.277049286e-05, 0.9062562627,
                                      0.09150303166, 0.9099517204, 596.3148142};
    const double y = std::pow(std::clamp(luminance, 0.005, 10000.), p[3]);
    return std::max(0., p[6] * (std::pow((p[0] + p[1] * y) / (1 + p[2] * y), p[4]) - p[5]));
}

PixelPlane ssimMap(const Image& image, const Image& reference, double factor, double white, int threads) {
    const std::vector<float> gauss = window();
    const auto mean = [&](const PixelPlane& plane) { return filtered(plane, gauss, gauss, threads); };
    PixelPlane a = perceived(image, factor * white), b = perceived(reference, factor * white);
    // Variances do not depend on the level, but their float rounding does: taken about the middle of the range.
    const double range = pu21(white);
    const auto middle = static_cast<float>(range / 2);
    for (PixelPlane* plane : {&a, &b})
        for (float& value : plane->values) value -= middle;
    const PixelPlane mean_a = mean(a), mean_b = mean(b);
    const PixelPlane mean_aa = mean(product(a, a)), mean_bb = mean(product(b, b)), mean_ab = mean(product(a, b));
    const double c1 = 0.01 * range * 0.01 * range, c2 = 0.03 * range * 0.03 * range;
    PixelPlane ssim(image.width, image.height);
    for (std::size_t i = 0; i < ssim.values.size(); ++i) {
        const double ma = mean_a.values[i], mb = mean_b.values[i];
        const double var_a = mean_aa.values[i] - ma * ma, var_b = mean_bb.values[i] - mb * mb;
        const double covariance = mean_ab.values[i] - ma * mb;
        const double la = ma + middle, lb = mb + middle;
        ssim.values[i] = static_cast<float>((2 * la * lb + c1) * (2 * covariance + c2) /
                                            ((la * la + lb * lb + c1) * (var_a + var_b + c2)));
    }
    return ssim;
}

}  // namespace searchlight
