// Where a flight cannot meet the surface, so that no ray is asked. Around a cell of a grid, a ball cut by a plane holds
// no surface: a flight that starts in the cell, is shorter than the ball reaches and has both ends below the plane
// stays inside it, since such a region is convex.
#pragma once

#include <cstdint>
#include <vector>

#include "base/large_pages.h"
#include "scene/mesh.h"
#include "transport/mesh/distance_bounds.h"

namespace searchlight {

/// A ball about the middle of a cell, cut by a plane. Eight bytes, since walks read them all over the mesh: the normal
/// need not be unit, and the numbers are rounded so that the region shrinks.
struct SafeRegion {
    static constexpr double kNormal = 511;  ///< length of a normal, about
    static constexpr double kSteps = 1024;  ///< of lengths, to a cell
    static constexpr double kLargest = 30;  ///< radius, in cells

    std::uint32_t normal = 0;  ///< x, y, z of 10 bits, from the highest; 0: there is no plane
    std::uint16_t radius = 0;  ///< in steps; 0: nothing is known
    std::int16_t offset = 1;   ///< normal . (p - middle) is below kNormal times so many steps
};

struct SafeRegions {
    Vec3f origin;  ///< lowest corner of the grid, mm
    float cell_mm = 0;
    std::int32_t nx = 0, ny = 0, nz = 0;  ///< cells; a multiple of 8
    std::vector<SafeRegion, LargePages<SafeRegion>>
        regions;  ///< in bricks of 8 x 8 x 8 cells, which lie in one page; x runs fastest

    std::size_t indexOf(std::int32_t x, std::int32_t y, std::int32_t z) const;
    /// Whether a flight between two points surely stays inside the mesh. False outside of the grid.
    bool safe(Vec3f from, Vec3f to) const;
};

/// Regions of a closed mesh for flights of that mean length.
SafeRegions buildSafeRegions(const Mesh& mesh, double cell_mm, double mfp_mm, int threads = 0);

/// A single cell around the box from low to high about which nothing is known: every flight needs a ray.
SafeRegions unknownRegion(Vec3 low, Vec3 high);

}  // namespace searchlight
