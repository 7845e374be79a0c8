// A balanced binary tree that is walked without a stack and without pointers, on a device, too.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/vec.h"

namespace searchlight {

/// Node 1 is the root, 2 i and 2 i + 1 are the children of i, so a whole subtree is left by (i + 1) >> findLSB(i + 1).
/// Depends on positions alone. Siblings hold the same number of points, give or take one.
struct HeapTree {
    int depth = 0;                              ///< the leaves are nodes 2^depth to 2^(depth + 1) - 1
    std::vector<std::uint32_t> order;           ///< indices of the points, leaf after leaf
    std::vector<std::array<float, 4>> spheres;  ///< per node (0 is none): centre of the bounding box, radius, mm

    std::size_t nodes() const { return spheres.size(); }

    /// Where in `order` the points of node 2^level + k begin; those of its last sibling end at k = 2^level.
    std::size_t first(int level, std::size_t k) const { return order.size() * k >> level; }
};

/// Splits at the median of the longest side until a leaf holds at most `leaf_size` points. Requires a point.
HeapTree buildHeapTree(std::span<const Vec3f> positions, std::size_t leaf_size, int threads);

}  // namespace searchlight
