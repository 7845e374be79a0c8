#include "geometry/surface_points.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
#include "geometry/point_areas.h"
#include "geometry/point_grid.h"
#include "geometry/point_start.h"
#include "geometry/surface_walk.h"

namespace searchlight {

namespace {

// How points push each other apart. Distances are in spacings, the square root of the area per point.
struct Repulsion {
    int rounds = 0;
    float reach = 2;     // beyond it there is no force; it falls to 0 linearly, [Turk1992]
    float strength = 0;  // of the step, in spacings per unit of force
};

class Relaxation {
public:
    Relaxation(const SurfaceWalk& walk, std::vector<SurfacePlace>& places, double spacing, int threads)
        : walk_(walk),
          places_(places),
          spacing_(spacing),
          threads_(threads),
          positions_(places.size()),
          normals_(places.size()) {
        update();
    }

    void round(const Repulsion& repulsion) {
        const float reach = repulsion.reach * static_cast<float>(spacing_);
        const PointGrid grid(positions_, reach);
        constexpr std::size_t chunk = 16;
        parallelFor((grid.blocks() + chunk - 1) / chunk, threads_, [&](std::size_t c) {
            std::vector<PointGrid::Cell> cells;
            std::vector<PointGrid::Entry> near;
            for (std::size_t b = c * chunk; b < std::min(grid.blocks(), (c + 1) * chunk); ++b) {
                grid.cellsOf(b, cells);
                for (const PointGrid::Cell& cell : cells) {
                    near.clear();
                    grid.gatherAround(cell, near);
                    for (const PointGrid::Entry& own : cell.entries)
                        places_[own.index] =
                            walk_.move(places_[own.index], stepOf(push(own, near, reach), repulsion.strength));
                }
            }
        });
        update();
    }

    const std::vector<Vec3f>& positions() const { return positions_; }

private:
    // Sum of unit pushes, which fall linearly to 0 at `reach`. A neighbour pushes along the straight line, flattened
    // into the plane of the point, but as hard as its true distance has it; one on the far side of something thin,
    // whose normal differs by more than 105 degrees, does not push.
    Vec3f push(const PointGrid::Entry& own, const std::vector<PointGrid::Entry>& near, float reach) const {
        const Vec3f n = normals_[own.index];
        Vec3f sum;
        for (const PointGrid::Entry& other : near) {
            const float x = own.position.x - other.position.x, y = own.position.y - other.position.y,
                        z = own.position.z - other.position.z;
            const float distance2 = x * x + y * y + z * z;
            if (distance2 >= reach * reach) continue;
            const Vec3f m = normals_[other.index];
            if (n.x * m.x + n.y * m.y + n.z * m.z < -0.25f) continue;
            const float up = x * n.x + y * n.y + z * n.z;
            const float flat2 = distance2 - up * up;
            // The point itself, and what lies exactly above it.
            if (flat2 <= 1e-6f * distance2) continue;
            const float size = (1 - std::sqrt(distance2) / reach) / std::sqrt(flat2);
            sum.x += size * (x - up * n.x);
            sum.y += size * (y - up * n.y);
            sum.z += size * (z - up * n.z);
        }
        return sum;
    }

    Vec3 stepOf(Vec3f push, double strength) const {
        const Vec3 step = (strength * spacing_) * toDouble(push);
        // Where many points start in a heap, none is thrown further than a spacing.
        const double size = length(step);
        return size > spacing_ ? (spacing_ / size) * step : step;
    }

    void update() {
        constexpr std::size_t chunk = 4096;
        parallelFor((places_.size() + chunk - 1) / chunk, threads_, [&](std::size_t c) {
            for (std::size_t i = c * chunk; i < std::min(places_.size(), (c + 1) * chunk); ++i) {
                positions_[i] = toFloat(walk_.position(places_[i]));
                normals_[i] = toFloat(walk_.normal(places_[i].triangle));
            }
        });
    }

    const SurfaceWalk& walk_;
    std::vector<SurfacePlace>& places_;
    double spacing_;
    int threads_;
    std::vector<Vec3f> positions_, normals_;
};

}  // namespace

PointCloud samplePoints(const Mesh& mesh, const PointOptions& options, Observer& observer) {
    const double area = surfaceArea(mesh);
    if (!(area > 0) || !std::isfinite(area)) throw inputError("the mesh has no area to put points on");
    if (options.count == 0) return {};
    const SurfaceWalk walk(mesh);
    const bool turk = options.method == PointMethod::turk;
    std::vector<SurfacePlace> places = turk ? randomPlaces(mesh, options.count, options.seed, options.threads)
                                            : stratifiedPlaces(mesh, options.count, options.seed, options.threads);
    // More strength makes points swing to and fro: at 0.5 the areas scatter by half as much again.
    const Repulsion repulsion{.rounds = turk ? 40 : 12, .reach = 2, .strength = 0.3f};
    Relaxation relaxation(walk, places, std::sqrt(area / static_cast<double>(options.count)), options.threads);
    for (int i = 0; i < repulsion.rounds; ++i) {
        if (observer.cancelled()) throw interruptedError();
        relaxation.round(repulsion);
        observer.progress("points", static_cast<std::uint64_t>(i) + 1, static_cast<std::uint64_t>(repulsion.rounds),
                          "rounds");
    }
    PointCloud cloud;
    cloud.positions = relaxation.positions();
    cloud.areas = nearestAreas(mesh, walk, places, cloud.positions, options.threads);
    cloud.normals.resize(places.size());
    for (std::size_t i = 0; i < places.size(); ++i) cloud.normals[i] = toFloat(walk.shadingNormal(places[i]));
    return cloud;
}

}  // namespace searchlight
