#include "geometry/cloud_estimate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nanoflann.hpp>
#include <numbers>
#include <queue>
#include <tuple>

#include "base/parallel.h"

namespace searchlight {

namespace {

constexpr std::size_t wanted = 12;
constexpr std::size_t chunk = 1024;

struct Points {
    std::span<const Vec3f> positions;

    std::size_t kdtree_get_point_count() const { return positions.size(); }
    float kdtree_get_pt(std::size_t i, std::size_t axis) const {
        return axis == 0 ? positions[i].x : axis == 1 ? positions[i].y : positions[i].z;
    }
    template <class Box>
    bool kdtree_get_bbox(Box&) const {
        return false;
    }
};

// The nearest points of every point, itself left out, nearest first; `each` of them.
struct NearLists {
    std::size_t each = 0;
    std::vector<std::uint32_t> indices;
    std::vector<float> distances2;
};

NearLists nearLists(std::span<const Vec3f> positions, int threads) {
    using Tree =
        nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Points>, Points, 3, std::uint32_t>;
    NearLists lists;
    lists.each = positions.empty() ? 0 : std::min(wanted, positions.size() - 1);
    lists.indices.resize(lists.each * positions.size());
    lists.distances2.resize(lists.each * positions.size());
    if (lists.each == 0) return lists;
    const Points points{positions};
    const Tree tree(3, points, nanoflann::KDTreeSingleIndexAdaptorParams(12));
    parallelFor((positions.size() + chunk - 1) / chunk, threads, [&](std::size_t c) {
        std::uint32_t found[wanted + 1];
        float distances2[wanted + 1];
        for (std::size_t i = c * chunk; i < std::min(positions.size(), (c + 1) * chunk); ++i) {
            const float at[3] = {positions[i].x, positions[i].y, positions[i].z};
            tree.knnSearch(at, lists.each + 1, found, distances2);
            // The point is among them, unless others at the same place have taken its turn.
            std::size_t kept = 0;
            for (std::size_t k = 0; k <= lists.each && kept < lists.each; ++k) {
                if (found[k] == i) continue;
                lists.indices[i * lists.each + kept] = found[k];
                lists.distances2[i * lists.each + kept++] = distances2[k];
            }
        }
    });
    return lists;
}

// Eigenvector of the smallest eigenvalue of a symmetric matrix, by Jacobi's rotations.
Vec3 smallestAxis(double (&m)[3][3]) {
    double v[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int sweep = 0; sweep < 8; ++sweep)
        for (int p = 0; p < 2; ++p)
            for (int q = p + 1; q < 3; ++q) {
                if (std::abs(m[p][q]) < 1e-30) continue;
                const double theta = (m[q][q] - m[p][p]) / (2 * m[p][q]);
                const double t = std::copysign(1.0, theta) / (std::abs(theta) + std::sqrt(theta * theta + 1));
                const double c = 1 / std::sqrt(t * t + 1), s = t * c;
                for (int k = 0; k < 3; ++k) {
                    const double a = m[k][p], b = m[k][q];
                    m[k][p] = c * a - s * b, m[k][q] = s * a + c * b;
                }
                for (int k = 0; k < 3; ++k) {
                    const double a = m[p][k], b = m[q][k];
                    m[p][k] = c * a - s * b, m[q][k] = s * a + c * b;
                }
                for (int k = 0; k < 3; ++k) {
                    const double a = v[k][p], b = v[k][q];
                    v[k][p] = c * a - s * b, v[k][q] = s * a + c * b;
                }
            }
    int least = 0;
    for (int k = 1; k < 3; ++k)
        if (m[k][k] < m[least][least]) least = k;
    return {v[0][least], v[1][least], v[2][least]};
}

Vec3 planeNormal(std::span<const Vec3f> positions, std::size_t i, const NearLists& near) {
    const Vec3 origin = toDouble(positions[i]);
    Vec3 mean;
    for (std::size_t k = 0; k < near.each; ++k)
        mean = mean + toDouble(positions[near.indices[i * near.each + k]]) - origin;
    mean = (1.0 / (static_cast<double>(near.each) + 1)) * mean;
    double m[3][3] = {};
    for (std::size_t k = 0; k <= near.each; ++k) {
        const Vec3 way =
            (k < near.each ? toDouble(positions[near.indices[i * near.each + k]]) - origin : Vec3{}) - mean;
        const double x[3] = {way.x, way.y, way.z};
        for (int a = 0; a < 3; ++a)
            for (int b = 0; b < 3; ++b) m[a][b] += x[a] * x[b];
    }
    return smallestAxis(m);
}

// What can be reached from outside without passing a cell that holds points.
class Outside {
public:
    Outside(std::span<const Vec3f> positions, double spacing) {
        low_ = high_ = positions[0];
        for (const Vec3f p : positions) {
            low_ = {std::min(low_.x, p.x), std::min(low_.y, p.y), std::min(low_.z, p.z)};
            high_ = {std::max(high_.x, p.x), std::max(high_.y, p.y), std::max(high_.z, p.z)};
        }
        const double sizes[3] = {double(high_.x) - low_.x, double(high_.y) - low_.y, double(high_.z) - low_.z};
        // At 2.5 spacings a wall of cells has no holes; 16 million cells are enough.
        cell_ = std::max(2.5 * spacing, std::max({sizes[0], sizes[1], sizes[2]}) / 250);
        for (int axis = 0; axis < 3; ++axis) dims_[axis] = static_cast<int>(sizes[axis] / cell_) + 5;
        cells_.assign(std::size_t(dims_[0]) * dims_[1] * dims_[2], unknown);
        for (const Vec3f p : positions) cells_[indexOf(toDouble(p))] = wall;
        flood();
    }

    double cell() const { return cell_; }
    bool contains(Vec3 p) const {
        const auto beyond = [&](double x, float low, float high) { return x < low - cell_ || x > high + cell_; };
        if (beyond(p.x, low_.x, high_.x) || beyond(p.y, low_.y, high_.y) || beyond(p.z, low_.z, high_.z)) return true;
        return cells_[indexOf(p)] == outside;
    }

private:
    enum : std::uint8_t { unknown, wall, outside };

    std::size_t indexOf(Vec3 p) const {
        const auto x = static_cast<std::size_t>((p.x - low_.x) / cell_ + 2),
                   y = static_cast<std::size_t>((p.y - low_.y) / cell_ + 2),
                   z = static_cast<std::size_t>((p.z - low_.z) / cell_ + 2);
        return (z * dims_[1] + y) * dims_[0] + x;
    }

    void flood() {
        std::vector<std::array<int, 3>> open{{0, 0, 0}};
        cells_[0] = outside;
        while (!open.empty()) {
            const std::array<int, 3> at = open.back();
            open.pop_back();
            for (int axis = 0; axis < 3; ++axis)
                for (const int way : {-1, 1}) {
                    std::array<int, 3> next = at;
                    next[axis] += way;
                    if (next[axis] < 0 || next[axis] >= dims_[axis]) continue;
                    std::uint8_t& cell = cells_[(std::size_t(next[2]) * dims_[1] + next[1]) * dims_[0] + next[0]];
                    if (cell != unknown) continue;
                    cell = outside;
                    open.push_back(next);
                }
        }
    }

    Vec3f low_, high_;
    double cell_ = 1;
    int dims_[3] = {};
    std::vector<std::uint8_t> cells_;
};

// Turns normals that have the outside on one side only; the others, of thin or open parts, stay unsure.
std::vector<std::uint8_t> turnOutward(std::span<const Vec3f> positions, const NearLists& near,
                                      std::vector<Vec3f>& normals) {
    std::vector<float> reaches(positions.size());
    for (std::size_t i = 0; i < reaches.size(); ++i) reaches[i] = near.distances2[(i + 1) * near.each - 1];
    const auto median = reaches.begin() + static_cast<std::ptrdiff_t>(reaches.size() / 2);
    std::nth_element(reaches.begin(), median, reaches.end());
    const double spacing = std::sqrt(*median * std::numbers::pi / static_cast<double>(near.each));
    std::vector<std::uint8_t> sure(positions.size());
    if (!(spacing > 0)) return sure;
    const Outside outside(positions, spacing);
    for (std::size_t i = 0; i < sure.size(); ++i) {
        const Vec3 p = toDouble(positions[i]), n = toDouble(normals[i]);
        int score = 0;
        for (const double cells : {1.0, 1.5, 2.0})
            score +=
                outside.contains(p + cells * outside.cell() * n) - outside.contains(p - cells * outside.cell() * n);
        if (score < 0) normals[i] = toFloat(-1.0 * n);
        sure[i] = std::abs(score) >= 2;
    }
    return sure;
}

// Prim's algorithm, from all that is sure at once; a component without any starts from its highest point.
void orient(std::span<const Vec3f> positions, const NearLists& near, std::vector<Vec3f>& normals) {
    // Nearness need not be mutual: edges are walked from both ends.
    std::vector<std::uint32_t> starts(positions.size() + 1), others(2 * near.indices.size());
    for (std::size_t e = 0; e < near.indices.size(); ++e) ++starts[e / near.each + 1], ++starts[near.indices[e] + 1];
    for (std::size_t i = 1; i < starts.size(); ++i) starts[i] += starts[i - 1];
    std::vector<std::uint32_t> next(starts.begin(), starts.end() - 1);
    for (std::size_t e = 0; e < near.indices.size(); ++e) {
        const auto from = static_cast<std::uint32_t>(e / near.each);
        others[next[from]++] = near.indices[e];
        others[next[near.indices[e]]++] = from;
    }
    std::vector<std::uint32_t> by_height(positions.size());
    for (std::size_t i = 0; i < by_height.size(); ++i) by_height[i] = static_cast<std::uint32_t>(i);
    std::ranges::stable_sort(by_height,
                             [&](std::uint32_t a, std::uint32_t b) { return positions[a].y > positions[b].y; });

    struct Edge {
        float differs;
        std::uint32_t from, to;
        bool operator<(const Edge& other) const {
            return std::tie(differs, to, from) > std::tie(other.differs, other.to, other.from);
        }
    };
    std::vector<std::uint8_t> done(positions.size());
    std::priority_queue<Edge> open;
    const auto dotOf = [&](std::uint32_t a, std::uint32_t b) {
        return normals[a].x * normals[b].x + normals[a].y * normals[b].y + normals[a].z * normals[b].z;
    };
    const auto take = [&](std::uint32_t i) {
        done[i] = 1;
        for (std::uint32_t k = starts[i]; k < starts[i + 1]; ++k)
            if (!done[others[k]]) open.push({1 - std::abs(dotOf(i, others[k])), i, others[k]});
    };
    const auto turn = [&](std::uint32_t i) { normals[i] = {-normals[i].x, -normals[i].y, -normals[i].z}; };
    const auto spread = [&] {
        while (!open.empty()) {
            const Edge edge = open.top();
            open.pop();
            if (done[edge.to]) continue;
            if (dotOf(edge.from, edge.to) < 0) turn(edge.to);
            take(edge.to);
        }
    };
    const std::vector<std::uint8_t> sure = turnOutward(positions, near, normals);
    for (std::uint32_t i = 0; i < sure.size(); ++i)
        if (sure[i]) take(i);
    spread();
    for (const std::uint32_t highest : by_height) {
        if (done[highest]) continue;
        if (normals[highest].y < 0) turn(highest);
        take(highest);
        spread();
    }
}

}  // namespace

std::vector<Vec3f> estimateNormals(std::span<const Vec3f> positions, int threads) {
    std::vector<Vec3f> normals(positions.size(), Vec3f{0, 1, 0});
    if (positions.size() < 3) return normals;
    const NearLists near = nearLists(positions, threads);
    parallelFor((positions.size() + chunk - 1) / chunk, threads, [&](std::size_t c) {
        for (std::size_t i = c * chunk; i < std::min(positions.size(), (c + 1) * chunk); ++i)
            normals[i] = toFloat(planeNormal(positions, i, near));
    });
    orient(positions, near, normals);
    return normals;
}

std::vector<float> estimateAreas(std::span<const Vec3f> positions, int threads) {
    const NearLists near = nearLists(positions, threads);
    std::vector<float> areas(positions.size());
    if (near.each == 0) return areas;
    // The mean area of a disc to the k-th neighbour of a Poisson process is k times the area of a point.
    const double share = std::numbers::pi / static_cast<double>(near.each);
    for (std::size_t i = 0; i < areas.size(); ++i)
        areas[i] = static_cast<float>(share * near.distances2[(i + 1) * near.each - 1]);
    return areas;
}

}  // namespace searchlight
