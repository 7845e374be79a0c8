// Boxes, spheres and splits of lists of positions: what both trees are built with.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>

#include "base/vec.h"

namespace searchlight {

/// A position and where it stood in the caller's list.
struct Located {
    Vec3f position;
    std::uint32_t index;
};

inline float coordinate(Vec3f a, int axis) { return axis == 0 ? a.x : axis == 1 ? a.y : a.z; }

struct Box {
    Vec3f low{std::numeric_limits<float>::infinity(), std::numeric_limits<float>::infinity(),
              std::numeric_limits<float>::infinity()};
    Vec3f high{-std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity(),
               -std::numeric_limits<float>::infinity()};

    void add(Vec3f a) {
        low = {std::min(low.x, a.x), std::min(low.y, a.y), std::min(low.z, a.z)};
        high = {std::max(high.x, a.x), std::max(high.y, a.y), std::max(high.z, a.z)};
    }
    void add(const Box& box) {
        add(box.low);
        add(box.high);
    }
    Vec3f centre() const {
        return {0.5f * low.x + 0.5f * high.x, 0.5f * low.y + 0.5f * high.y, 0.5f * low.z + 0.5f * high.z};
    }
    Vec3f extent() const { return {high.x - low.x, high.y - low.y, high.z - low.z}; }
    float diagonalSquare() const {
        const Vec3f e = extent();
        return e.x * e.x + e.y * e.y + e.z * e.z;
    }
    int longestAxis() const {
        const Vec3f e = extent();
        return e.x >= e.y && e.x >= e.z ? 0 : e.y >= e.z ? 1 : 2;
    }
};

inline Box boundingBox(std::span<const Located> points) {
    Box box;
    for (const Located& point : points) box.add(point.position);
    return box;
}

/// Of the smallest sphere about `centre` that holds the points, a few roundings larger.
inline float radiusAbout(Vec3f centre, std::span<const Located> points) {
    float square = 0;
    for (const Located& point : points) {
        const float dx = point.position.x - centre.x, dy = point.position.y - centre.y,
                    dz = point.position.z - centre.z;
        square = std::max(square, dx * dx + dy * dy + dz * dz);
    }
    return std::sqrt(square) * (1 + 1e-6f);
}

/// About half of n, rounded up to full leaves, so that only the last leaf is not full. Requires n > leaf.
inline std::size_t halfOf(std::size_t n, std::size_t leaf) { return (n / 2 + leaf - 1) / leaf * leaf; }

/// Moves the `count` points with the least coordinate to the front.
inline void splitAt(std::span<Located> points, std::size_t count, int axis) {
    std::nth_element(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(count), points.end(),
                     [axis](const Located& a, const Located& b) {
                         return coordinate(a.position, axis) < coordinate(b.position, axis);
                     });
}

}  // namespace searchlight
