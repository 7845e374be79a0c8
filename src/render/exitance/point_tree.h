// The inside of a PointTree.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "render/exitance_sum.h"

namespace searchlight {

/// Nodes stand level by level, so the two children of a node are neighbours. The tree is that of the positions alone;
/// moments are about the centre of a node's sphere.
struct PointTree::Impl {
    static constexpr std::size_t leaf_size = 8;
    /// Floats per node: per channel the flux, its first and its second moments (x y z, xx xy xz yy yz zz).
    static constexpr std::size_t moments_per_node = 32, moments_per_channel = 10;
    /// Radius of a node without light: it passes every test of smallness.
    static constexpr float dark = -1e30f;

    Impl(const PointCloud& points, int threads);
    void setTransmitted(std::span<const Rgbf> transmitted, int threads);

    std::vector<std::uint32_t> order;         ///< of the cloud, in the tree's order
    std::vector<float> x, y, z, area;         ///< points, mm and mm^2
    std::array<std::vector<float>, 3> flux;   ///< of a point: transmitted times area times 1 / unit
    std::vector<float> spheres;               ///< x, y, z and radius per node; `dark` for the radius of some
    std::vector<float> whole;                 ///< the same of all points, lit or not
    std::vector<std::int32_t> child;          ///< the first of two, or -1: a leaf
    std::vector<std::uint32_t> first, count;  ///< points of the node
    std::vector<std::uint32_t> level;         ///< first node of each level, and the number of nodes
    std::vector<float> moments;               ///< one node more than there are: all 0
    /// Per node the cube root of its flux over the RMS flux per mm^2, of the channel where that is largest, mm^(2/3).
    std::vector<float> weight;
    Rgb unit{1, 1, 1};  ///< largest transmitted flux per mm^2: keeps floats in range
    std::array<bool, 3> lit{};
    double total_area = 0;
    std::uint64_t fingerprint = 0;  ///< of positions and light
};

}  // namespace searchlight
