// Directions from the centre of a sphere.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/directions.h"
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

}  // namespace searchlight
