// Pictures made by formula, for metrics that others have computed on them.
#pragma once

#include <cmath>

#include "base/image.h"

namespace searchlight {

/// Rings and stripes with colours of all hues, in [0, 1].
inline Image rings(int width, int height) {
    Image image(width, height);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const double u = x - 0.4 * width, v = y - 0.6 * height, r = std::sqrt(u * u + v * v);
            image.at(x, y) = {static_cast<float>(0.5 + 0.5 * std::sin(0.35 * r)),
                              static_cast<float>(0.5 + 0.4 * std::cos(0.11 * u)),
                              static_cast<float>(0.3 + 0.3 * std::sin(0.05 * v + 1)), 1};
        }
    }
    return image;
}

/// Somewhat brighter, shifted in colour, and with a square of another colour.
inline Image alteredRings(int width, int height) {
    Image image = rings(width, height);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            Rgba& p = image.at(x, y);
            const auto wave = static_cast<float>(0.05 * std::sin(0.9 * x) * std::sin(0.7 * y));
            p = {std::fmin(1.f, 1.1f * p.r + 0.02f), std::fmax(0.f, p.g + wave), 0.8f * p.b, 1};
            if (x > width / 2 && x < width / 2 + 12 && y > height / 3 && y < height / 3 + 9) p = {0.1f, 0.6f, 0.9f, 1};
        }
    }
    return image;
}

}  // namespace searchlight
