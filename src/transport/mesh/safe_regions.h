// Where a flight cannot meet the surface, so that no ray is asked. Around a cell of a grid, a ball cut by a plane holds
// no surface: a flight that starts in the cell, is shorter than the ball reaches and has both ends below the plane
// stays inside it, since such a region is convex.
#pragma once

#include <cstdint>
#include <vector>

#include "scene/mesh.h"
#include "transport/mesh/distance_bounds.h"

namespace searchlight {

struct SafeRegion {
    float x = 0, y = 0, z = 0;  ///< the plane's normal; 0: there is none
    float offset = 1;           ///< the plane is where normal . position has this value, mm
    float reach_mm = 0;         ///< of flights from anywhere in the cell
    float unused[3] = {};       ///< a region does not straddle cache lines
};

struct SafeRegions {
    Vec3f origin;  ///< lowest corner of the grid, mm
    float cell_mm = 0;
    std::int32_t nx = 0, ny = 0, nz = 0;
    std::vector<std::int32_t> regions_of;  ///< per cell, x runs fastest
    std::vector<SafeRegion> regions;       ///< the first is of no use: cells outside

    /// Whether a flight between two points surely stays inside the mesh. False outside of the grid.
    bool safe(Vec3f from, Vec3f to) const;
};

/// Regions of a closed mesh for flights of that mean length.
SafeRegions buildSafeRegions(const Mesh& mesh, double cell_mm, double mfp_mm, int threads = 0);

/// A single cell around the box from low to high about which nothing is known: every flight needs a ray.
SafeRegions unknownRegion(Vec3 low, Vec3 high);

}  // namespace searchlight
