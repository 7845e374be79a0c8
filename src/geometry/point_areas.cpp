#include "geometry/point_areas.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <memory>

#include "base/parallel.h"
#include "geometry/point_grid.h"
#include "geometry/point_start.h"
#include "geometry/vertex_normals.h"

namespace searchlight {

namespace {

// Pieces for each point. The standard deviation that they leave in an area is measured in bench/points_bench.
constexpr double pieces_per_point = 16;

// Points whose normals differ by more than 105 degrees lie on the other side of something thin.
constexpr float same_side = -0.25f;

struct Corners {
    Vec3 p[3];
};

class Assignment {
public:
    Assignment(const Mesh& mesh, const SurfaceWalk& walk, std::span<const SurfacePlace> places,
               std::span<const Vec3f> positions, double area)
        : mesh_(mesh),
          spacing_(std::sqrt(area / static_cast<double>(positions.size()))),
          grid_(positions, static_cast<float>(spacing_)),
          normals_(positions.size()),
          // Whole units make the sums independent of their order; all of them together stay below 2^62.
          units_per_area_(0x1p62 / area),
          units_(std::make_unique<std::atomic<std::uint64_t>[]>(positions.size())) {
        for (std::size_t i = 0; i < normals_.size(); ++i) normals_[i] = toFloat(walk.normal(places[i].triangle));
    }

    void add(std::size_t triangle) {
        const auto& corners = mesh_.triangles[triangle];
        Corners whole;
        for (int k = 0; k < 3; ++k) whole.p[k] = toDouble(mesh_.positions[corners[k]]);
        const Vec3 normal = triangleNormal(mesh_, triangle);
        const double area = length(normal) / 2;
        if (area > 0) addPart(whole, area, toFloat((0.5 / area) * normal));
    }

    std::vector<float> areas() const {
        std::vector<float> result(normals_.size());
        for (std::size_t i = 0; i < result.size(); ++i)
            result[i] = static_cast<float>(static_cast<double>(units_[i].load()) / units_per_area_);
        return result;
    }

private:
    // Halves the longest side until the candidates around the part are few.
    void addPart(const Corners& part, double area, Vec3f normal) {
        double longest = 0;
        int at = 0;
        for (int k = 0; k < 3; ++k)
            if (const double side = length(part.p[(k + 1) % 3] - part.p[k]); side > longest) longest = side, at = k;
        if (longest > 3 * spacing_) {
            const Vec3 a = part.p[at], b = part.p[(at + 1) % 3], c = part.p[(at + 2) % 3], middle = 0.5 * (a + b);
            addPart({{a, middle, c}}, area / 2, normal);
            addPart({{middle, b, c}}, area / 2, normal);
            return;
        }
        addPieces(part, area, normal);
    }

    void addPieces(const Corners& part, double area, Vec3f normal) {
        const int cuts =
            std::max(1, static_cast<int>(std::ceil(std::sqrt(area / (spacing_ * spacing_) * pieces_per_point))));
        const auto units = static_cast<std::uint64_t>(area * units_per_area_ / (double(cuts) * cuts));
        // Wider and wider until every piece has a point: 1.5 spacings nearly always do.
        thread_local std::vector<PointGrid::Entry> near;
        double margin = 1.5 * spacing_;
        gather(part, margin, near);
        const Vec3 e1 = part.p[1] - part.p[0], e2 = part.p[2] - part.p[0];
        for (int j = 0; j < cuts; ++j)
            for (int i = 0; i + j < cuts; ++i)
                for (const bool upper : {false, true}) {
                    if (upper && i + j + 1 >= cuts) continue;
                    const double third = upper ? 2.0 / 3 : 1.0 / 3;
                    const Vec3f at = toFloat(part.p[0] + ((i + third) / cuts) * e1 + ((j + third) / cuts) * e2);
                    while (true) {
                        const Nearest found = nearest(at, normal, near, margin);
                        if (found.distance2 <= margin * margin) {
                            units_[found.index].fetch_add(units, std::memory_order_relaxed);
                            break;
                        }
                        margin *= 2;
                        gather(part, margin, near);
                    }
                }
    }

    struct Nearest {
        std::uint32_t index = 0;
        float distance2 = std::numeric_limits<float>::infinity();
    };

    // Of the points on the same side where the margin holds any, else of all.
    Nearest nearest(Vec3f at, Vec3f normal, const std::vector<PointGrid::Entry>& near, double margin) const {
        Nearest same, any;
        for (const PointGrid::Entry& entry : near) {
            const float x = entry.position.x - at.x, y = entry.position.y - at.y, z = entry.position.z - at.z;
            const float distance2 = x * x + y * y + z * z;
            if (distance2 >= same.distance2) continue;
            const Vec3f n = normals_[entry.index];
            if (n.x * normal.x + n.y * normal.y + n.z * normal.z > same_side)
                same = {entry.index, distance2};
            else if (distance2 < any.distance2)
                any = {entry.index, distance2};
        }
        return same.distance2 <= margin * margin ? same : any;
    }

    void gather(const Corners& part, double margin, std::vector<PointGrid::Entry>& near) const {
        Vec3 low = part.p[0], high = low;
        for (const Vec3 p : part.p) {
            low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
            high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
        }
        const Vec3 around{margin, margin, margin};
        near.clear();
        grid_.gather(toFloat(low - around), toFloat(high + around), near);
    }

    const Mesh& mesh_;
    double spacing_;
    PointGrid grid_;
    std::vector<Vec3f> normals_;
    double units_per_area_;
    std::unique_ptr<std::atomic<std::uint64_t>[]> units_;
};

}  // namespace

std::vector<float> nearestAreas(const Mesh& mesh, const SurfaceWalk& walk, std::span<const SurfacePlace> places,
                                std::span<const Vec3f> positions, int threads) {
    Assignment assignment(mesh, walk, places, positions, surfaceArea(mesh));
    constexpr std::size_t chunk = 256;
    parallelFor((mesh.triangles.size() + chunk - 1) / chunk, threads, [&](std::size_t c) {
        for (std::size_t t = c * chunk; t < std::min(mesh.triangles.size(), (c + 1) * chunk); ++t) assignment.add(t);
    });
    return assignment.areas();
}

}  // namespace searchlight
