// Directions from the centre of a sphere.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "transport/mesh/surface_cells.h"

namespace searchlight {

/// Uniform within a cell for two uniform numbers in [0, 1).
inline Vec3 directionInCell(const SphereCells& cells, std::size_t cell, double u, double v) {
    const auto columns = static_cast<std::size_t>(cells.columns);
    const double y = 1 - 2 * (static_cast<double>(cell / columns) + u) / cells.rows;
    const double turn = 2 * std::numbers::pi * (static_cast<double>(cell % columns) + v) / cells.columns;
    const double ring = std::sqrt(std::max(0.0, (1 - y) * (1 + y)));
    return {ring * std::cos(turn), y, ring * std::sin(turn)};
}

/// At an angle of that cosine from the axis, a unit vector; `turn` (radians) says on which side. Frame of [Duff2017].
inline Vec3 directionAround(Vec3 axis, double cosine, double turn) {
    const double sign = std::copysign(1.0, axis.z), k = -1 / (sign + axis.z), xy = axis.x * axis.y * k;
    const Vec3 tangent{1 + sign * axis.x * axis.x * k, sign * xy, -sign * axis.x};
    const Vec3 bitangent{xy, sign + axis.y * axis.y * k, -axis.y};
    const double sine = std::sqrt(std::max(0.0, (1 - cosine) * (1 + cosine)));
    return normalize(cosine * axis + sine * std::cos(turn) * tangent + sine * std::sin(turn) * bitangent);
}

}  // namespace searchlight
