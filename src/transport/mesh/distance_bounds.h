// How far a point inside a closed mesh is from its surface, at least: steps shorter than that cannot cross it.
#pragma once

#include <cstdint>
#include <vector>

#include "scene/mesh.h"

namespace searchlight {

/// A grid of cubic cells over the mesh and two cells beyond. A value holds for every point of its cell, and with a
/// margin for the rounding of positions. 0: near the surface, or outside.
struct DistanceBounds {
    Vec3f origin;       ///< lowest corner, mm
    float cell_mm = 0;  ///< side of a cell
    std::int32_t nx = 0, ny = 0, nz = 0;
    float unit_mm = 0;                 ///< a value times this is the bound
    std::vector<std::uint8_t> values;  ///< x runs fastest
    std::vector<bool> outside;         ///< cells that lie outside altogether

    /// mm; 0 outside of the grid.
    float at(Vec3f position) const;
};

/// Cells of cell_mm on a side (larger where the mesh would need more than 512 a side). The mesh is closed. Up to
/// `reach_mm` from the surface bounds come from exact distances of cell centres, beyond from a distance transform.
DistanceBounds buildDistanceBounds(const Mesh& mesh, double cell_mm, double reach_mm, int threads = 0);

/// Square of the distance from p to the triangle abc.
double squaredDistance(Vec3 p, Vec3 a, Vec3 b, Vec3 c);

}  // namespace searchlight
