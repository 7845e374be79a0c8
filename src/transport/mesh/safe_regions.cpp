#include "transport/mesh/safe_regions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "base/parallel.h"
#include "geometry/vertex_normals.h"

namespace searchlight {

namespace {

constexpr double kReachCells = 2.5;  // exact distances up to here; the transform loses a cell's diagonal beyond

// Balls to choose from, by how far they let flights go in mean free paths: the wider, the more a curved surface pushes
// the plane back.
constexpr std::array kReaches{1.0, 2.0};

// Of what a plane is moved back by, in cells: positions are rounded.
constexpr double kMargin = 1e-3;

struct Sphere {
    Vec3 centre;
    double radius = 0;
};

// Triangles by where their middles are; those much larger than the bins stand apart.
class Bins {
public:
    Bins(const Mesh& mesh, double side) : mesh_(mesh), side_(side) {
        constexpr double infinity = std::numeric_limits<double>::infinity();
        low_ = {infinity, infinity, infinity};
        Vec3 high{-infinity, -infinity, -infinity};
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
            const auto& [a, b, c] = mesh.triangles[t];
            const std::array corners{toDouble(mesh.positions[a]), toDouble(mesh.positions[b]),
                                     toDouble(mesh.positions[c])};
            Sphere around{(1 / 3.0) * (corners[0] + corners[1] + corners[2]), 0};
            for (const Vec3& corner : corners) around.radius = std::max(around.radius, length(corner - around.centre));
            spheres_.push_back(around);
            normals_.push_back(triangleNormal(mesh, t));
            const Vec3 p = around.centre;
            low_ = {std::min(low_.x, p.x), std::min(low_.y, p.y), std::min(low_.z, p.z)};
            high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
        }
        const Vec3 extent = high - low_;
        side_ = std::max(side_, std::max({extent.x, extent.y, extent.z}) / 200);
        nx_ = along(extent.x) + 1, ny_ = along(extent.y) + 1, nz_ = along(extent.z) + 1;
        first_.assign(static_cast<std::size_t>(nx_) * ny_ * nz_ + 1, 0);
        for (std::size_t t = 0; t < spheres_.size(); ++t)
            if (spheres_[t].radius > side_)
                large_.push_back(static_cast<std::uint32_t>(t));
            else
                ++first_[binOf(t) + 1];
        for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
        list_.resize(first_.back());
        std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
        for (std::size_t t = 0; t < spheres_.size(); ++t)
            if (spheres_[t].radius <= side_) list_[next[binOf(t)]++] = static_cast<std::uint32_t>(t);
    }

    struct Near {
        std::uint32_t triangle;
        double distance;  // at most that of the triangle from the point
    };

    void near(Vec3 p, double radius, std::vector<Near>& found) const {
        found.clear();
        const auto test = [&](std::uint32_t t) {
            double distance = length(spheres_[t].centre - p) - spheres_[t].radius;
            if (distance >= radius) return;
            // A small triangle is as near as the sphere around it; of a large one that says little.
            if (spheres_[t].radius > 0.1 * radius) {
                const auto& [a, b, c] = mesh_.triangles[t];
                distance = std::sqrt(squaredDistance(p, toDouble(mesh_.positions[a]), toDouble(mesh_.positions[b]),
                                                     toDouble(mesh_.positions[c])));
            }
            if (distance < radius) found.push_back({t, distance});
        };
        for (const std::uint32_t t : large_) test(t);
        const Vec3 at = p - low_;
        const double reach = radius + side_;
        for (int z = clamped(at.z - reach, nz_); z <= clamped(at.z + reach, nz_); ++z)
            for (int y = clamped(at.y - reach, ny_); y <= clamped(at.y + reach, ny_); ++y)
                for (int x = clamped(at.x - reach, nx_); x <= clamped(at.x + reach, nx_); ++x) {
                    const std::size_t bin = (static_cast<std::size_t>(z) * ny_ + y) * nx_ + x;
                    for (std::uint32_t i = first_[bin]; i < first_[bin + 1]; ++i) test(list_[i]);
                }
    }

    Vec3 normal(std::uint32_t t) const { return normals_[t]; }
    // The least of n . v over a triangle.
    double lowest(std::uint32_t t, Vec3 n) const {
        double lowest = std::numeric_limits<double>::infinity();
        for (const std::uint32_t v : mesh_.triangles[t])
            lowest = std::min(lowest, dot(n, toDouble(mesh_.positions[v])));
        return lowest;
    }

private:
    int along(double x) const { return static_cast<int>(x / side_); }
    int clamped(double x, int n) const { return static_cast<int>(std::clamp(x / side_, 0.0, n - 1.0)); }
    std::size_t binOf(std::size_t t) const {
        const Vec3 p = spheres_[t].centre - low_;
        return (static_cast<std::size_t>(clamped(p.z, nz_)) * ny_ + clamped(p.y, ny_)) * nx_ + clamped(p.x, nx_);
    }

    const Mesh& mesh_;
    double side_;
    Vec3 low_;
    int nx_ = 1, ny_ = 1, nz_ = 1;
    std::vector<Sphere> spheres_;
    std::vector<Vec3> normals_;  // of twice the area's length
    std::vector<std::uint32_t> first_, list_, large_;
};

// About the part of flights from the middle of a cell that a region cannot clear.
double uncleared(double reach_mfp, double depth_mfp) {
    return std::exp(-reach_mfp) + 0.5 * std::exp(-1.5 * std::max(depth_mfp, 0.0));
}

// Rounded down, and less what rounding does to the distance of a point.
std::uint16_t stepsOf(double radius, double cell) {
    return static_cast<std::uint16_t>(
        std::clamp(SafeRegion::kSteps * (radius / cell - kMargin), 0.0, SafeRegion::kSteps * SafeRegion::kLargest));
}

// A unit normal as the walks know it.
Vec3 quantized(Vec3 n) {
    return {std::round(SafeRegion::kNormal * n.x), std::round(SafeRegion::kNormal * n.y),
            std::round(SafeRegion::kNormal * n.z)};
}

std::uint32_t packed(Vec3 n) {
    const auto bits = [](double x) { return static_cast<std::uint32_t>(static_cast<std::int32_t>(x)) & 0x3FF; };
    return bits(n.x) << 22 | bits(n.y) << 12 | bits(n.z) << 2;
}

Vec3 unpacked(std::uint32_t normal) {
    const auto number = [](std::uint32_t bits) { return static_cast<double>(static_cast<std::int32_t>(bits) >> 22); };
    return {number(normal), number(normal << 10), number(normal << 20)};
}

// The best of several balls around a cell's middle. `bound`: the distance from any point of the cell to the surface.
SafeRegion chooseRegion(const Bins& bins, Vec3 middle, double half_diagonal, double cell, double bound, double mfp,
                        std::vector<Bins::Near>& near) {
    SafeRegion best;
    best.radius = bound > 0 ? stepsOf(bound + half_diagonal, cell) : std::uint16_t{0};
    double least = std::exp(-bound / mfp);
    bins.near(middle, half_diagonal + kReaches.back() * mfp, near);
    for (const double reach : kReaches) {
        const double radius = std::min(half_diagonal + reach * mfp, SafeRegion::kLargest * cell);
        Vec3 sum;
        for (const auto& [triangle, distance] : near)
            if (distance < radius) sum = sum + bins.normal(triangle);
        if (!(length(sum) > 0)) continue;
        const Vec3 n = quantized(normalize(sum));
        double lowest = std::numeric_limits<double>::infinity();
        for (const auto& [triangle, distance] : near)
            if (distance < radius) lowest = std::min(lowest, bins.lowest(triangle, n));
        const double offset = (lowest - dot(n, middle)) / SafeRegion::kNormal - kMargin * cell;
        // A cell that the plane leaves out altogether gains nothing; one that it cuts counts by its lower part.
        if (offset < -half_diagonal) continue;
        const double missed = uncleared(reach, std::max(offset, 0.5 * (offset + half_diagonal)) / mfp);
        if (missed >= least) continue;
        least = missed;
        best.normal = packed(n);
        best.radius = stepsOf(radius, cell);
        best.offset =
            static_cast<std::int16_t>(std::clamp(std::floor(SafeRegion::kSteps * offset / cell), -32'000.0, 32'000.0));
    }
    return best;
}

}  // namespace

std::size_t SafeRegions::indexOf(std::int32_t x, std::int32_t y, std::int32_t z) const {
    const auto brick = (static_cast<std::size_t>(z >> 3) * (ny >> 3) + (y >> 3)) * (nx >> 3) + (x >> 3);
    return brick << 9 | static_cast<std::size_t>((z & 7) << 6 | (y & 7) << 3 | (x & 7));
}

bool SafeRegions::safe(Vec3f from, Vec3f to) const {
    const auto cellOf = [this](float position, float low) {
        return static_cast<std::int32_t>(std::floor((position - low) / cell_mm));
    };
    const std::int32_t x = cellOf(from.x, origin.x), y = cellOf(from.y, origin.y), z = cellOf(from.z, origin.z);
    if (x < 0 || y < 0 || z < 0 || x >= nx || y >= ny || z >= nz) return false;
    if (regions.empty()) return false;
    const SafeRegion& region = regions[indexOf(x, y, z)];
    const double step = static_cast<double>(cell_mm) / SafeRegion::kSteps;
    const Vec3 middle = toDouble(origin) + static_cast<double>(cell_mm) * Vec3{x + 0.5, y + 0.5, z + 0.5};
    const auto holds = [&](Vec3f p) {
        const Vec3 away = toDouble(p) - middle;
        return length(away) < step * region.radius &&
               dot(unpacked(region.normal), away) < SafeRegion::kNormal * step * region.offset;
    };
    return holds(from) && holds(to);
}

SafeRegions buildSafeRegions(const Mesh& mesh, double cell_mm, double mfp_mm, int threads) {
    const DistanceBounds bounds = buildDistanceBounds(mesh, cell_mm, kReachCells * cell_mm, threads);
    const auto bricks = [](std::int32_t n) { return (n + 7) / 8 * 8; };
    SafeRegions safe{bounds.origin, bounds.cell_mm, bricks(bounds.nx), bricks(bounds.ny), bricks(bounds.nz), {}};
    safe.regions.resize(static_cast<std::size_t>(safe.nx) * safe.ny * safe.nz);
    const double cell = static_cast<double>(bounds.cell_mm), half_diagonal = 0.5 * std::sqrt(3.0) * cell;
    const Bins bins(mesh, std::max(2 * cell, kReaches.back() * mfp_mm));
    const Vec3 origin = toDouble(bounds.origin);
    parallelFor(static_cast<std::size_t>(bounds.ny) * bounds.nz, threads, [&](std::size_t row) {
        const auto y = static_cast<std::int32_t>(row % static_cast<std::size_t>(bounds.ny));
        const auto z = static_cast<std::int32_t>(row / static_cast<std::size_t>(bounds.ny));
        std::vector<Bins::Near> near;
        for (std::int32_t x = 0; x < bounds.nx; ++x) {
            const std::size_t at = row * static_cast<std::size_t>(bounds.nx) + static_cast<std::size_t>(x);
            if (bounds.outside[at]) continue;
            const double bound = static_cast<double>(bounds.unit_mm) * bounds.values[at];
            SafeRegion& region = safe.regions[safe.indexOf(x, y, z)];
            if (bound >= kReaches.back() * mfp_mm)  // no plane beats the bound
                region.radius = stepsOf(bound + half_diagonal, cell);
            else
                region = chooseRegion(bins, origin + cell * Vec3{x + 0.5, y + 0.5, z + 0.5}, half_diagonal, cell, bound,
                                      mfp_mm, near);
        }
    });
    return safe;
}

SafeRegions unknownRegion(Vec3 low, Vec3 high) {
    const Vec3 extent = high - low;
    const double longest = std::max({extent.x, extent.y, extent.z});
    return {toFloat(low - 0.004 * longest * Vec3{1, 1, 1}), static_cast<float>(1.01 * longest), 1, 1, 1, {}};
}

}  // namespace searchlight
