#include "transport/mesh/safe_regions.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "transport/mesh/distance_bounds.h"

namespace searchlight {

namespace {

constexpr double kReachCells = 2.5;  // exact distances up to here; the transform loses a cell's diagonal beyond
constexpr double kMargin = 1e-3;     // of what rounding does to the distance of a point, in cells
constexpr double kFar = 2.0;         // mean free paths: no plane beats a ball of that radius

std::uint32_t stepsOf(double radius, double cell) {
    return static_cast<std::uint32_t>(
        std::clamp(SafeRegion::kSteps * radius / cell, 0.0, SafeRegion::kSteps * SafeRegion::kLargest));
}

std::uint32_t packed(Vec3 n) {
    const auto bits = [](double x) { return static_cast<std::uint32_t>(static_cast<std::int32_t>(x)) & 0x3FF; };
    return bits(n.x) << 22 | bits(n.y) << 12 | bits(n.z) << 2;
}

Vec3 unpacked(std::uint32_t normal) {
    const auto number = [](std::uint32_t bits) { return static_cast<double>(static_cast<std::int32_t>(bits) >> 22); };
    return {number(normal), number(normal << 10), number(normal << 20)};
}

SafeRegion rounded(const CutBall& ball, double cell) {
    SafeRegion region;
    region.radius = stepsOf(ball.radius, cell);
    for (int i = 0; i < ball.planes; ++i) {
        region.normals[i] = packed(ball.normals[i]);
        region.offsets[i] = static_cast<std::int16_t>(std::clamp(
            std::floor(SafeRegion::kSteps * ball.offsets[i] / (CutBall::kNormal * cell)), -32'000.0, 32'000.0));
    }
    return region;
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
    if (cells.empty()) return false;
    const std::uint32_t entry = cells[indexOf(x, y, z)];
    const SafeRegion& region = regions[(entry & kCut) != 0 ? entry & ~kCut : 0];
    const double radius = (entry & kCut) != 0 ? region.radius : entry;
    const double step = static_cast<double>(cell_mm) / SafeRegion::kSteps;
    const Vec3 middle = toDouble(origin) + static_cast<double>(cell_mm) * Vec3{x + 0.5, y + 0.5, z + 0.5};
    const auto holds = [&](Vec3f p) {
        const Vec3 away = toDouble(p) - middle;
        bool inside = length(away) < step * radius;
        for (std::size_t i = 0; i < SafeRegion::kPlanes; ++i)
            inside = inside && dot(unpacked(region.normals[i]), away) < CutBall::kNormal * step * region.offsets[i];
        return inside;
    };
    return holds(from) && holds(to);
}

SafeRegions buildSafeRegions(const Mesh& mesh, double cell_mm, double mfp_mm, int threads) {
    const DistanceBounds bounds = buildDistanceBounds(mesh, cell_mm, kReachCells * cell_mm, threads);
    const auto bricks = [](std::int32_t n) { return (n + 7) / 8 * 8; };
    SafeRegions safe{bounds.origin, bounds.cell_mm, bricks(bounds.nx), bricks(bounds.ny), bricks(bounds.nz), {}, {}};
    safe.cells.resize(static_cast<std::size_t>(safe.nx) * safe.ny * safe.nz);
    const double cell = static_cast<double>(bounds.cell_mm), half_diagonal = 0.5 * std::sqrt(3.0) * cell;
    const NearTriangles triangles(mesh, std::max(2 * cell, kFar * mfp_mm));
    const Vec3 origin = toDouble(bounds.origin);
    const std::size_t rows = static_cast<std::size_t>(bounds.ny) * bounds.nz;
    struct Cut {
        std::size_t cell;
        SafeRegion region;
    };
    std::vector<std::vector<Cut>> cuts(rows);
    parallelFor(rows, threads, [&](std::size_t row) {
        const auto y = static_cast<std::int32_t>(row % static_cast<std::size_t>(bounds.ny));
        const auto z = static_cast<std::int32_t>(row / static_cast<std::size_t>(bounds.ny));
        CutBallChooser chooser(triangles, cell, mfp_mm);
        for (std::int32_t x = 0; x < bounds.nx; ++x) {
            const std::size_t at = row * static_cast<std::size_t>(bounds.nx) + static_cast<std::size_t>(x);
            if (bounds.outside[at]) continue;
            const double bound = static_cast<double>(bounds.unit_mm) * bounds.values[at];
            const std::size_t index = safe.indexOf(x, y, z);
            if (bound >= kFar * mfp_mm) {
                safe.cells[index] = stepsOf(bound + half_diagonal - kMargin * cell, cell);
                continue;
            }
            const CutBall ball = chooser.choose(origin + cell * Vec3{x + 0.5, y + 0.5, z + 0.5}, bound);
            if (ball.planes == 0)
                safe.cells[index] = stepsOf(ball.radius, cell);
            else
                cuts[row].push_back({index, rounded(ball, cell)});
        }
    });
    safe.regions.push_back({});
    for (const std::vector<Cut>& row : cuts)
        for (const auto& [index, region] : row) {
            safe.cells[index] = SafeRegions::kCut | static_cast<std::uint32_t>(safe.regions.size());
            safe.regions.push_back(region);
        }
    return safe;
}

SafeRegions unknownRegion(Vec3 low, Vec3 high) {
    const Vec3 extent = high - low;
    const double longest = std::max({extent.x, extent.y, extent.z});
    return {toFloat(low - 0.004 * longest * Vec3{1, 1, 1}), static_cast<float>(1.01 * longest), 1, 1, 1, {}, {}};
}

}  // namespace searchlight
