#include "render/heap_tree.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

#include "base/parallel.h"

namespace searchlight {

namespace {

float component(const Vec3f& p, int axis) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }

struct Box {
    Vec3f low, high;

    Vec3f size() const { return {high.x - low.x, high.y - low.y, high.z - low.z}; }
    int longestAxis() const {
        const Vec3f s = size();
        return s.x >= s.y && s.x >= s.z ? 0 : s.y >= s.z ? 1 : 2;
    }
};

Box boxOf(std::span<const Vec3f> positions, std::span<const std::uint32_t> chosen) {
    Box box{positions[chosen.front()], positions[chosen.front()]};
    for (const std::uint32_t i : chosen) {
        const Vec3f& p = positions[i];
        box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y), std::min(box.low.z, p.z)};
        box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y), std::max(box.high.z, p.z)};
    }
    return box;
}

std::array<float, 4> sphereOf(std::span<const Vec3f> positions, std::span<const std::uint32_t> chosen, const Box& box) {
    const Vec3f c{0.5f * (box.low.x + box.high.x), 0.5f * (box.low.y + box.high.y), 0.5f * (box.low.z + box.high.z)};
    float square = 0;
    for (const std::uint32_t i : chosen) {
        const float x = positions[i].x - c.x, y = positions[i].y - c.y, z = positions[i].z - c.z;
        square = std::max(square, x * x + y * y + z * z);
    }
    return {c.x, c.y, c.z, std::sqrt(square)};
}

}  // namespace

HeapTree buildHeapTree(std::span<const Vec3f> positions, std::size_t leaf_size, int threads) {
    assert(!positions.empty() && leaf_size > 0);
    HeapTree tree;
    tree.order.resize(positions.size());
    std::iota(tree.order.begin(), tree.order.end(), 0u);
    while ((positions.size() - 1) >> tree.depth >= leaf_size) ++tree.depth;
    tree.spheres.resize(std::size_t{2} << tree.depth);
    for (int level = 0; level <= tree.depth; ++level) {
        parallelFor(std::size_t{1} << level, threads, [&](std::size_t k) {
            const auto begin = tree.order.begin() + static_cast<std::ptrdiff_t>(tree.first(level, k));
            const auto end = tree.order.begin() + static_cast<std::ptrdiff_t>(tree.first(level, k + 1));
            if (begin == end) return;
            const Box box = boxOf(positions, {begin, end});
            tree.spheres[(std::size_t{1} << level) + k] = sphereOf(positions, {begin, end}, box);
            if (level == tree.depth) return;
            const auto middle = tree.order.begin() + static_cast<std::ptrdiff_t>(tree.first(level + 1, 2 * k + 1));
            if (middle == end) return;
            const int axis = box.longestAxis();
            std::nth_element(begin, middle, end, [&](std::uint32_t a, std::uint32_t b) {
                return component(positions[a], axis) < component(positions[b], axis);
            });
        });
    }
    return tree;
}

}  // namespace searchlight
