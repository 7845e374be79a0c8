// Charts put beside one another on a grid of texels.
#pragma once

#include <vector>

#include "geometry/atlas/overlap.h"

namespace searchlight {

/// A chart in the plane, in the surface's unit.
using FlatChart = std::vector<FlatTriangle>;

struct Packing {
    double texels_per_unit = 0;                     ///< one scale for all charts
    std::vector<std::vector<FlatTriangle>> placed;  ///< chart by chart, in texels, within [0, resolution]^2
};

/// Turns each chart so that its box is small, and finds the largest scale at which all find room on resolution^2
/// texels: every texel that a chart touches is its own, and `gutter` texels around it are empty. Triangles with area,
/// all counter-clockwise. Throws a usage Error where there is no room at any scale.
Packing packCharts(const std::vector<FlatChart>& charts, int resolution, int gutter);

}  // namespace searchlight
