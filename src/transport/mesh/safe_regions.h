// Where a flight cannot meet the surface, so that no ray is asked. Around a cell of a grid, a ball cut by planes holds
// no surface: a flight with both ends in it stays inside, since such a region is convex.
#pragma once

#include <cstdint>
#include <vector>

#include "base/large_pages.h"
#include "scene/mesh.h"
#include "transport/mesh/region_planes.h"

namespace searchlight {

/// A ball about the middle of a cell, cut by planes. The numbers are rounded so that the region shrinks.
struct alignas(8 * CutBall::kMostPlanes) SafeRegion {
    static constexpr std::size_t kPlanes = CutBall::kMostPlanes;
    static constexpr double kSteps = 1024;  ///< of lengths, to a cell
    static constexpr double kLargest = 30;  ///< radius, in cells

    std::uint32_t normals[kPlanes] = {};     ///< x, y, z of 10 bits, from the highest; 0: there is no plane
    std::int16_t offsets[kPlanes] = {1, 1};  ///< normal . (p - middle) is below kNormal times so many steps
    std::uint32_t radius = 0;                ///< in steps; 0: nothing is known
};

struct SafeRegions {
    Vec3f origin;  ///< lowest corner of the grid, mm
    float cell_mm = 0;
    std::int32_t nx = 0, ny = 0, nz = 0;  ///< cells; a multiple of 8
    /// In bricks of 8 x 8 x 8 cells, which lie in one page; x runs fastest. The radius of a ball in steps, or kCut and
    /// the place of a region.
    std::vector<std::uint32_t, LargePages<std::uint32_t>> cells;
    std::vector<SafeRegion, LargePages<SafeRegion>> regions;  ///< of cells near the surface; the first is not cut
    static constexpr std::uint32_t kCut = 0x8000'0000;

    std::size_t indexOf(std::int32_t x, std::int32_t y, std::int32_t z) const;
    /// Whether a flight between two points surely stays inside the mesh. False outside of the grid.
    bool safe(Vec3f from, Vec3f to) const;
};

/// Regions of a closed mesh for flights of that mean length.
SafeRegions buildSafeRegions(const Mesh& mesh, double cell_mm, double mfp_mm, int threads = 0);

/// A single cell around the box from low to high about which nothing is known: every flight needs a ray.
SafeRegions unknownRegion(Vec3 low, Vec3 high);

}  // namespace searchlight
