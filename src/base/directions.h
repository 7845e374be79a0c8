// Directions about an axis.
#pragma once

#include <algorithm>
#include <cmath>

#include "base/vec.h"

namespace searchlight {

/// Two unit vectors at right angles to an axis, and to each other.
struct Frame {
    Vec3 tangent, bitangent;
};

/// Of a unit vector, without a case for any direction; [Duff2017].
inline Frame frameAround(Vec3 n) {
    const double sign = std::copysign(1.0, n.z), k = -1 / (sign + n.z), xy = n.x * n.y * k;
    return {{1 + sign * n.x * n.x * k, sign * xy, -sign * n.x}, {xy, sign + n.y * n.y * k, -n.y}};
}

/// At an angle of that cosine from the axis, a unit vector; `turn` (radians) says on which side.
inline Vec3 directionAround(Vec3 axis, double cosine, double turn) {
    const Frame frame = frameAround(axis);
    const double sine = std::sqrt(std::max(0.0, (1 - cosine) * (1 + cosine)));
    return normalize(cosine * axis + sine * std::cos(turn) * frame.tangent + sine * std::sin(turn) * frame.bitangent);
}

}  // namespace searchlight
