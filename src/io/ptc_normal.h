// How PTC packs a direction into 32 bits.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "base/vec.h"

namespace searchlight {

/// Azimuth about z and height, each in 65536 steps. Both at their largest mean no normal.
struct PtcNormal {
    std::uint16_t phi = 65535, z = 65535;
};

/// A unit vector; zero for no normal.
inline Vec3f decodePtcNormal(PtcNormal code) {
    if (code.phi == 65535 && code.z == 65535) return {};
    const double nz = 2 * code.z / 65535.0 - 1, phi = 2 * std::numbers::pi * (code.phi / 65535.0 - 0.5);
    const double s = std::sqrt(std::max(0.0, 1 - nz * nz));
    return toFloat(Vec3{s * std::sin(phi), s * std::cos(phi), nz});
}

/// Within 5e-5 rad in azimuth and 1.6e-5 in z. Expects a unit vector, or zero.
inline PtcNormal encodePtcNormal(Vec3f normal) {
    if (normal == Vec3f{}) return {};
    const auto code = [](double fraction) {
        return static_cast<std::uint16_t>(std::clamp(std::lround(65535 * fraction), 0L, 65535L));
    };
    const PtcNormal packed{code(std::atan2(normal.x, normal.y) / (2 * std::numbers::pi) + 0.5),
                           code(0.5 * (normal.z + 1.0))};
    // At the pole the azimuth is free, and 65535 is taken.
    return packed.phi == 65535 && packed.z == 65535 ? PtcNormal{0, 65535} : packed;
}

}  // namespace searchlight
