// The inside of a ReceiverTree.
#pragma once

#include <cstdint>
#include <vector>

#include "render/exitance/box.h"
#include "render/exitance_sum.h"

namespace searchlight {

/// Sphere and place of a node: children are neighbours.
struct ReceiverNode {
    Vec3f centre;
    float radius = 0;
    std::int32_t child = -1;  ///< the first of two, or -1: a leaf
    std::uint32_t first = 0, count = 0;
};

/// Node 0 is the root. A tile is a run of the caller's list; tiles that reach over a silhouette are cut apart there;
/// the pieces are the leaves of an upper tree and the roots of small ones.
struct ReceiverTree::Impl {
    static constexpr std::size_t leaf_size = 16, tile_size = 64;

    Impl(std::span<const Vec3f> receivers, int threads);

    std::vector<std::uint32_t> order;  ///< of the caller's list, in the tree's order
    std::vector<float> x, y, z;        ///< mm; a vector longer than the list, so that whole vectors can be read
    std::vector<ReceiverNode> nodes;   ///< empty without receivers
    std::uint64_t fingerprint = 0;
    double build_ms = 0;
};

}  // namespace searchlight
