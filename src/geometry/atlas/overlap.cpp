#include "geometry/atlas/overlap.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace searchlight {

namespace {

struct Box {
    Vec2 low{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
    Vec2 high{-low.x, -low.y};
    void take(Vec2 p) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
};

Box boxOf(const FlatTriangle& triangle) {
    Box box;
    for (const Vec2 p : triangle) box.take(p);
    return box;
}

// Whether a side of `a` has `a` on one hand and all of `b` on the other, but for the slack.
bool sideParts(const FlatTriangle& a, const FlatTriangle& b, double slack) {
    const double turn = cross(a[1] - a[0], a[2] - a[0]) < 0 ? -1 : 1;
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec2 side = a[(k + 1) % 3] - a[k];
        const double size = std::sqrt(dot(side, side));
        double deepest = -std::numeric_limits<double>::infinity();
        for (const Vec2 p : b) deepest = std::max(deepest, turn * cross(side, p - a[k]));
        if (deepest <= slack * size) return true;
    }
    return false;
}

}  // namespace

std::optional<std::pair<std::uint32_t, std::uint32_t>> overlaps(std::span<const FlatTriangle> triangles, double slack) {
    if (triangles.size() < 2) return std::nullopt;
    Box all;
    std::vector<Box> boxes;
    for (const FlatTriangle& triangle : triangles) {
        boxes.push_back(boxOf(triangle));
        all.take(boxes.back().low), all.take(boxes.back().high);
    }
    // About two triangles a cell.
    const auto cells = std::max<std::int64_t>(1, std::lround(std::sqrt(0.5 * static_cast<double>(triangles.size()))));
    const double width = std::max(all.high.x - all.low.x, 1e-300), height = std::max(all.high.y - all.low.y, 1e-300);
    const auto cellOf = [&](double offset, double size) {
        return std::clamp(static_cast<std::int64_t>(offset / size * static_cast<double>(cells)), std::int64_t{0},
                          cells - 1);
    };
    std::vector<std::vector<std::uint32_t>> grid(static_cast<std::size_t>(cells * cells));
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
        const Box& box = boxes[t];
        const std::int64_t x0 = cellOf(box.low.x - all.low.x, width), x1 = cellOf(box.high.x - all.low.x, width);
        const std::int64_t y0 = cellOf(box.low.y - all.low.y, height), y1 = cellOf(box.high.y - all.low.y, height);
        for (std::int64_t y = y0; y <= y1; ++y)
            for (std::int64_t x = x0; x <= x1; ++x) {
                auto& cell = grid[static_cast<std::size_t>(y * cells + x)];
                for (const std::uint32_t other : cell) {
                    const Box& beside = boxes[other];
                    if (box.low.x >= beside.high.x || beside.low.x >= box.high.x || box.low.y >= beside.high.y ||
                        beside.low.y >= box.high.y)
                        continue;
                    if (!sideParts(triangles[t], triangles[other], slack) &&
                        !sideParts(triangles[other], triangles[t], slack))
                        return std::pair{other, t};
                }
                cell.push_back(t);
            }
    }
    return std::nullopt;
}

}  // namespace searchlight
