#include <algorithm>
#include <cmath>

#include "base/srgb.h"
#include "io/image_file.h"

namespace searchlight {

namespace {

// [Narkowicz2015]: a rational fit of the ACES reference rendering transform with its output transform for sRGB.
double filmic(double x) {
    if (x > 1e6) return 1;  // the fit's limit is 2.51/2.43, and inf / inf is none
    return x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14);
}

float code(double radiance, double factor, const ToneMap& tone_map) {
    double value = std::max(0.0, radiance * factor);
    if (std::isnan(value)) return 0;
    if (tone_map.curve == ToneMap::Curve::filmic) value = filmic(value);
    value = srgbFromLinear(std::min(value, 1.0));
    return static_cast<float>(tone_map.gamma == 1 ? value : std::pow(value, 1 / tone_map.gamma));
}

}  // namespace

Rgba displayed(Rgba pixel, const ToneMap& tone_map) {
    const float alpha = std::isnan(pixel.a) ? 0.f : std::clamp(pixel.a, 0.f, 1.f);
    if (alpha == 0) return {0, 0, 0, 0};
    const double factor = std::exp2(tone_map.exposure) / alpha;
    return {code(pixel.r, factor, tone_map), code(pixel.g, factor, tone_map), code(pixel.b, factor, tone_map), alpha};
}

}  // namespace searchlight
