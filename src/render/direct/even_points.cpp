#include "render/direct/even_points.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/random.h"
#include "geometry/vertex_normals.h"

namespace searchlight {

namespace {

// Every bit of 10 followed by two zeros.
std::uint32_t spread(std::uint32_t bits) {
    bits = (bits | bits << 16) & 0x030000ffu;
    bits = (bits | bits << 8) & 0x0300f00fu;
    bits = (bits | bits << 4) & 0x030c30c3u;
    return (bits | bits << 2) & 0x09249249u;
}

std::vector<std::uint32_t> mortonOrder(const Mesh& mesh) {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    Vec3f low{infinity, infinity, infinity}, high{-infinity, -infinity, -infinity};
    for (const Vec3f& p : mesh.positions) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    const float size = std::max({high.x - low.x, high.y - low.y, high.z - low.z, 1e-30f});
    const auto cell = [&](float at, float from) {
        return spread(static_cast<std::uint32_t>(std::clamp((at - from) / size * 1023.0f, 0.0f, 1023.0f)));
    };
    std::vector<std::uint32_t> codes;
    for (const auto& [a, b, c] : mesh.triangles) {
        const Vec3f &p = mesh.positions[a], &q = mesh.positions[b], &r = mesh.positions[c];
        codes.push_back(cell((p.x + q.x + r.x) / 3, low.x) << 2 | cell((p.y + q.y + r.y) / 3, low.y) << 1 |
                        cell((p.z + q.z + r.z) / 3, low.z));
    }
    std::vector<std::uint32_t> order(codes.size());
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::stable_sort(order, {}, [&](std::uint32_t t) { return codes[t]; });
    return order;
}

}  // namespace

EvenPoints::EvenPoints(const Mesh& mesh, const SurfaceWalk& walk) : walk_(walk), order_(mortonOrder(mesh)) {
    cumulative_.push_back(0);
    for (const std::uint32_t t : order_)
        cumulative_.push_back(cumulative_.back() + 0.5 * length(triangleNormal(mesh, t)));
}

ChosenPoints EvenPoints::draw(std::size_t count, std::uint64_t seed) const {
    ChosenPoints points;
    points.positions.reserve(count);
    points.normals.reserve(count);
    std::size_t k = 0;
    for (std::size_t i = 0; i < count; ++i) {
        SplitMix64 random = streamOf(seed, i);
        const double at = (static_cast<double>(i) + random.uniform()) / static_cast<double>(count) * area();
        while (k + 1 < order_.size() && cumulative_[k + 1] <= at) ++k;
        // What is left of `at` in its triangle is uniform there: it serves as the first of the two numbers.
        const double share = (at - cumulative_[k]) / std::max(cumulative_[k + 1] - cumulative_[k], 1e-300);
        const double root = std::sqrt(std::clamp(share, 0.0, 1.0)), v = random.uniform();
        const SurfacePlace place{order_[k], root * (1 - v), root * v};
        points.positions.push_back(toFloat(walk_.position(place)));
        points.normals.push_back(toFloat(walk_.shadingNormal(place)));
    }
    return points;
}

}  // namespace searchlight
