// Edges of a mesh, with equal positions taken as one vertex.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geometry/weld.h"
#include "scene/mesh.h"

namespace searchlight {

/// One side of a triangle: from corner `side` to the next, or back.
struct HalfEdge {
    std::uint32_t low = 0, high = 0;  ///< welded vertices, low < high
    std::uint32_t triangle = 0;
    std::uint8_t side = 0;   ///< 0, 1, 2: starts at that corner
    bool ascending = false;  ///< runs from low to high
};

/// Every side of every triangle whose three corners differ after welding, ordered by (low, high, triangle): the sides
/// that meet in an edge are neighbours in the list.
std::vector<HalfEdge> halfEdges(const Mesh& mesh, const Weld& weld);

inline constexpr std::uint32_t no_triangle = ~std::uint32_t{0};

/// The triangle across side k of each triangle; no_triangle where the side is a boundary, or not shared by exactly two
/// oppositely oriented triangles.
std::vector<std::array<std::uint32_t, 3>> triangleNeighbours(const Mesh& mesh);

}  // namespace searchlight
