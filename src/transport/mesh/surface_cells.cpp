#include "transport/mesh/surface_cells.h"

#include <hwy/cache_control.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numbers>

#include "base/error.h"
#include "base/random.h"
#include "geometry/vertex_normals.h"

namespace searchlight {

namespace {

constexpr double kMostCells = 1 << 24;

Vec3 corner(const Mesh& mesh, std::size_t triangle, std::size_t i) {
    return toDouble(mesh.positions[mesh.triangles[triangle][i]]);
}

// Splits triangles into clusters by halving along the widest of six axes: place, and normal times the cell's size, so
// that the two faces of a thin wall do not share a cell.
class Clusters {
public:
    Clusters(const Mesh& mesh, double area_mm2) : area_(area_mm2) {
        const double size = std::sqrt(area_mm2);
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
            const Vec3 n = size * unitNormal(mesh, t);
            const Vec3 p = (1 / 3.0) * (corner(mesh, t, 0) + corner(mesh, t, 1) + corner(mesh, t, 2));
            keys_.push_back({p.x, p.y, p.z, n.x, n.y, n.z});
            areas_.push_back(triangleArea(mesh, t));
        }
    }

    // Calls found(triangles) for each cluster.
    template <class Found>
    void split(std::span<std::uint32_t> triangles, const Found& found) const {
        double area = 0;
        for (const std::uint32_t t : triangles) area += areas_[t];
        if (triangles.size() <= 1 || area <= area_) {
            if (!triangles.empty()) found(triangles);
            return;
        }
        std::size_t widest = 0;
        double width = -1;
        for (std::size_t axis = 0; axis < 6; ++axis) {
            const auto [low, high] =
                std::ranges::minmax(triangles, {}, [&](std::uint32_t t) { return keys_[t][axis]; });
            if (keys_[high][axis] - keys_[low][axis] > width)
                widest = axis, width = keys_[high][axis] - keys_[low][axis];
        }
        const std::size_t half = triangles.size() / 2;
        // Ties are broken by number, so that the cut does not depend on the library.
        std::ranges::nth_element(
            triangles, triangles.begin() + static_cast<std::ptrdiff_t>(half), [&](std::uint32_t a, std::uint32_t b) {
                return keys_[a][widest] < keys_[b][widest] || (keys_[a][widest] == keys_[b][widest] && a < b);
            });
        split(triangles.first(half), found);
        split(triangles.subspan(half), found);
    }

private:
    double area_;
    std::vector<std::array<double, 6>> keys_;
    std::vector<double> areas_;
};

// The middle of a part along one side of the lattice.
float lattice(double at, bool upper, double sides) {
    return static_cast<float>((at + (upper ? 2 / 3.0 : 1 / 3.0)) / sides);
}

}  // namespace

double triangleArea(const Mesh& mesh, std::size_t triangle) { return 0.5 * length(triangleNormal(mesh, triangle)); }

Vec3 unitNormal(const Mesh& mesh, std::size_t triangle) {
    const Vec3 n = triangleNormal(mesh, triangle);
    const double size = length(n);
    return size > 0 ? (1 / size) * n : Vec3{};
}

SurfaceCells::SurfaceCells(const Mesh& mesh, double area_mm2) : parts_(mesh.triangles.size()) {
    std::vector<std::uint32_t> small;
    for (std::size_t t = 0; t < parts_.size(); ++t) {
        const double area = triangleArea(mesh, t);
        const double sides = area_mm2 > 0 ? std::max(1.0, std::ceil(std::sqrt(area / area_mm2))) : 1;
        if (area_mm2 > 0 && sides == 1) {
            small.push_back(static_cast<std::uint32_t>(t));
            continue;
        }
        const double parts = sides * sides;
        if (static_cast<double>(areas_.size()) + parts > kMostCells)
            throw inputError("the surface would be cut into more than 16 million cells", "choose larger cells");
        parts_[t] = {static_cast<std::uint32_t>(areas_.size()), static_cast<std::uint32_t>(sides)};
        areas_.insert(areas_.end(), static_cast<std::size_t>(parts), area / parts);
    }
    if (small.empty()) return;
    Clusters(mesh, area_mm2).split(small, [&](std::span<const std::uint32_t> cluster) {
        double area = 0;
        for (const std::uint32_t t : cluster) {
            parts_[t] = {static_cast<std::uint32_t>(areas_.size()), 1};
            area += triangleArea(mesh, t);
        }
        areas_.push_back(area);
    });
    if (static_cast<double>(areas_.size()) > kMostCells)
        throw inputError("the surface would be cut into more than 16 million cells", "choose larger cells");
}

void SurfaceCells::seek(std::uint32_t triangle) const { hwy::Prefetch(&parts_[triangle]); }

std::uint32_t SurfaceCells::at(std::uint32_t triangle, float u, float v) const {
    assert(triangle < parts_.size());
    const Part part = parts_[triangle];
    if (part.sides == 1) return part.first;
    const auto n = static_cast<std::int64_t>(part.sides);
    const double x = static_cast<double>(u) * part.sides, y = static_cast<double>(v) * part.sides;
    const auto row = std::clamp(static_cast<std::int64_t>(x), std::int64_t{0}, n - 1);
    const auto across = std::clamp(static_cast<std::int64_t>(y), std::int64_t{0}, n - 1 - row);
    // A square of the lattice is two cells, but for the last of a row.
    const bool upper = across < n - 1 - row && x - static_cast<double>(row) + y - static_cast<double>(across) > 1;
    return part.first + static_cast<std::uint32_t>(row * (2 * n - row) + 2 * across + (upper ? 1 : 0));
}

double SphereCells::area_mm2() const {
    return 4 * std::numbers::pi * radius_mm * radius_mm / (static_cast<double>(rows) * columns);
}

std::uint32_t SphereCells::at(Vec3 p) const {
    const double y = p.y / length(p), turn = std::atan2(p.z, p.x) / (2 * std::numbers::pi);
    const int row = std::clamp(static_cast<int>(0.5 * (1 - y) * rows), 0, rows - 1);
    const int column = std::clamp(static_cast<int>((turn - std::floor(turn)) * columns), 0, columns - 1);
    return static_cast<std::uint32_t>(row * columns + column);
}

SphereCells makeSphereCells(double radius_mm, double area_mm2) {
    const double cells = 4 * std::numbers::pi * radius_mm * radius_mm / area_mm2;
    if (!(cells <= kMostCells))
        throw inputError("the surface would be cut into more than 16 million cells", "choose larger cells");
    const int rows = std::max(1, static_cast<int>(std::ceil(std::sqrt(0.5 * cells))));
    return {radius_mm, rows, 2 * rows};
}

CellPoints SurfaceCells::sample(const Mesh& mesh, int per_cell, std::uint64_t seed) const {
    assert(mesh.triangles.size() == parts_.size() && per_cell > 0);
    CellPoints points;
    SplitMix64 random(seed);
    std::vector<double> passed(size(), 0.0), next(size());  // of a cell's area, in points
    for (double& n : next) n = random.uniform();
    for (std::size_t t = 0; t < parts_.size(); ++t) {
        const Vec3 a = corner(mesh, t, 0), b = corner(mesh, t, 1), c = corner(mesh, t, 2);
        const double n = parts_[t].sides, area = triangleArea(mesh, t) / (n * n);
        for (double row = 0; row < n; ++row)
            for (double across = 0; across < n - row; ++across)
                for (const bool upper : {false, true}) {
                    if (upper && across + 1 == n - row) continue;
                    const std::uint32_t cell =
                        at(static_cast<std::uint32_t>(t), lattice(row, upper, n), lattice(across, upper, n));
                    passed[cell] += per_cell * area / areas_[cell];
                    for (; next[cell] < passed[cell]; ++next[cell]) {
                        const double root = std::sqrt(random.uniform()), along = root * random.uniform();
                        const double u = (upper ? row + root : row + 1 - root) / n;
                        const double v = (upper ? across + 1 - along : across + along) / n;
                        points.cells.push_back(cell);
                        points.triangles.push_back(static_cast<std::uint32_t>(t));
                        points.positions.push_back(toFloat(a + u * (b - a) + v * (c - a)));
                        points.normals.push_back(toFloat(unitNormal(mesh, t)));
                    }
                }
    }
    return points;
}

std::vector<Rgb> averageOverCells(const CellPoints& points, std::span<const Rgbf> values, std::size_t cells) {
    assert(values.size() == points.cells.size());
    std::vector<Rgb> means(cells);
    std::vector<double> counts(cells, 0.0);
    for (std::size_t i = 0; i < values.size(); ++i) {
        Rgb& sum = means[points.cells[i]];
        sum = sum + toDouble(values[i]);
        ++counts[points.cells[i]];
    }
    for (std::size_t cell = 0; cell < cells; ++cell)
        if (counts[cell] > 0) means[cell] = (1 / counts[cell]) * means[cell];
    return means;
}

}  // namespace searchlight
