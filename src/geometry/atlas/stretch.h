// How far a parameterisation is from an isometry.
#pragma once

#include <array>
#include <span>

#include "geometry/atlas/overlap.h"

namespace searchlight {

/// From places in the plane to the surface, the scale of the whole being such that both have the same area: an
/// isometry has 1, 1, 0, 1.
struct Stretch {
    double l2 = 1;            ///< root of the mean over the surface of (Gamma^2 + gamma^2)/2 [Sander2001, L^2]
    double worst = 1;         ///< largest Gamma, the most that a unit of the plane is lengthened [Sander2001, L^inf]
    double area_rms = 0;      ///< of the logarithm of area on the surface over area in the plane
    double largest_area = 1;  ///< most surface per area in the plane: where texels are coarsest
};

/// A triangle on the surface and its place in the plane.
struct MappedTriangle {
    std::array<Vec3, 3> surface;
    FlatTriangle plane;
};

/// Triangles without area on the surface do not count. One without area, or turned over, in the plane makes all
/// infinite.
Stretch stretchOf(std::span<const MappedTriangle> triangles);

}  // namespace searchlight
