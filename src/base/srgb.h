// The curve of sRGB, IEC 61966-2-1.
#pragma once

#include <cmath>

namespace searchlight {

/// Code value in [0, 1] of linear light in [0, 1].
inline double srgbFromLinear(double linear) {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

/// Linear light in [0, 1] of a code value in [0, 1].
inline double linearFromSrgb(double code) {
    return code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4);
}

}  // namespace searchlight
