#include "geometry/cloud_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/point_grid.h"
#include "geometry/polygonise.h"

namespace searchlight {

namespace {

class Planes {
public:
    Planes(const PointCloud& cloud, double reach)
        : cloud_(cloud), reach_(reach), grid_(cloud.positions, static_cast<float>(reach)) {}

    // Signed distance to the planes of the points in reach; nothing where there are none.
    double distance(Vec3 p) const {
        double sum = 0, weights = 0;
        for (const PointGrid::Entry& entry : near(p, reach_)) {
            const Vec3 way = p - toDouble(entry.position);
            const double falls = 1 - dot(way, way) / (reach_ * reach_);
            if (falls <= 0) continue;
            const double weight = falls * falls * falls * falls;
            sum += weight * dot(way, toDouble(cloud_.normals[entry.index]));
            weights += weight;
        }
        return weights > 0 ? sum / weights : std::numeric_limits<double>::quiet_NaN();
    }

    bool anyWithin(Vec3 p, double radius) const { return !near(p, radius + reach_).empty(); }

private:
    const std::vector<PointGrid::Entry>& near(Vec3 p, double radius) const {
        thread_local std::vector<PointGrid::Entry> found;
        found.clear();
        const Vec3 around{radius, radius, radius};
        grid_.gather(toFloat(p - around), toFloat(p + around), found);
        return found;
    }

    const PointCloud& cloud_;
    double reach_;
    PointGrid grid_;
};

}  // namespace

Mesh surfaceThrough(const PointCloud& cloud, int threads) {
    if (cloud.positions.size() < 4) return {};
    std::vector<float> areas = cloud.areas;
    const auto median = areas.begin() + static_cast<std::ptrdiff_t>(areas.size() / 2);
    std::nth_element(areas.begin(), median, areas.end());
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Vec3 low{infinity, infinity, infinity}, high{-infinity, -infinity, -infinity};
    for (const Vec3f q : cloud.positions) {
        const Vec3 p = toDouble(q);
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    const double longest = std::max({high.x - low.x, high.y - low.y, high.z - low.z});
    if (!(longest > 0)) return {};
    // 1/400: a surface of a million triangles, which no picture needs finer.
    const double cell = std::max(1.5 * std::sqrt(static_cast<double>(*median)), longest / 400);
    // The diagonal of a cell and the way to the next point: every cell that the surface crosses knows all its corners.
    const Planes planes(cloud, 2.4 * cell);
    const Vec3 margin{4 * cell, 4 * cell, 4 * cell};
    return polygonise([&](Vec3 p) { return planes.distance(p); },
                      {.low = low - margin,
                       .high = high + margin,
                       .cell = cell,
                       .smoothing = 3,
                       .threads = threads,
                       .empty = [&](Vec3 p, double radius) { return !planes.anyWithin(p, radius); }});
}

}  // namespace searchlight
