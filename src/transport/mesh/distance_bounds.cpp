#include "transport/mesh/distance_bounds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "transport/mesh/facet_geometry.h"

namespace searchlight {

namespace {

constexpr int kMostCells = 512;
constexpr std::int32_t kSlab = 8;  // layers that one thread fills

// Of what a bound is reduced by, in cells: positions are rounded, and so is the cell that they fall into.
constexpr double kMargin = 1e-3;

struct Grid {
    Vec3 origin;
    double cell = 0;
    std::int32_t nx = 0, ny = 0, nz = 0;

    std::size_t size() const { return static_cast<std::size_t>(nx) * ny * nz; }
    std::size_t index(std::int32_t x, std::int32_t y, std::int32_t z) const {
        return (static_cast<std::size_t>(z) * ny + y) * nx + x;
    }
    Vec3 centre(std::int32_t x, std::int32_t y, std::int32_t z) const {
        return origin + cell * Vec3{x + 0.5, y + 0.5, z + 0.5};
    }
};

struct Range {
    std::int32_t first, last;  // cells whose centre may be within reach
};

Range rangeOf(double low, double high, double origin, double cell, double reach, std::int32_t n) {
    const auto clamped = [n](double value) {
        return static_cast<std::int32_t>(std::clamp(value, 0.0, static_cast<double>(n - 1)));
    };
    return {clamped(std::floor((low - reach - origin) / cell - 0.5)),
            clamped(std::ceil((high + reach - origin) / cell))};
}

// Distance from each cell's centre to the surface where that is below `reach`, `reach` elsewhere.
std::vector<float> nearDistances(const Mesh& mesh, const Grid& grid, double reach, int threads) {
    std::vector<float> distances(grid.size(), static_cast<float>(reach));
    const std::size_t slabs = static_cast<std::size_t>((grid.nz + kSlab - 1) / kSlab);
    std::vector<std::vector<std::uint32_t>> of_slab(slabs);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto [a, b, c] = cornersOf(mesh, t);
        const Range z =
            rangeOf(std::min({a.z, b.z, c.z}), std::max({a.z, b.z, c.z}), grid.origin.z, grid.cell, reach, grid.nz);
        for (std::int32_t slab = z.first / kSlab; slab <= z.last / kSlab; ++slab)
            of_slab[static_cast<std::size_t>(slab)].push_back(static_cast<std::uint32_t>(t));
    }
    parallelFor(slabs, threads, [&](std::size_t slab) {
        const std::int32_t z0 = static_cast<std::int32_t>(slab) * kSlab, z1 = std::min(z0 + kSlab, grid.nz);
        for (const std::uint32_t t : of_slab[slab]) {
            const auto [a, b, c] = cornersOf(mesh, t);
            const auto along = [&](double Vec3::*axis, std::int32_t n) {
                const auto [low, high] = std::minmax({a.*axis, b.*axis, c.*axis});
                return rangeOf(low, high, grid.origin.*axis, grid.cell, reach, n);
            };
            const Range xs = along(&Vec3::x, grid.nx), ys = along(&Vec3::y, grid.ny), zs = along(&Vec3::z, grid.nz);
            for (std::int32_t z = std::max(zs.first, z0); z <= std::min(zs.last, z1 - 1); ++z)
                for (std::int32_t y = ys.first; y <= ys.last; ++y)
                    for (std::int32_t x = xs.first; x <= xs.last; ++x) {
                        float& distance = distances[grid.index(x, y, z)];
                        const double square = squaredDistance(grid.centre(x, y, z), a, b, c);
                        if (square < static_cast<double>(distance) * distance)
                            distance = static_cast<float>(std::sqrt(square));
                    }
        }
    });
    return distances;
}

// One pass of the exact Euclidean distance transform along a line: squares f(q) become min over p of (q - p)^2 + f(p),
// the lower envelope of parabolas [Felzenszwalb2012].
class LineTransform {
public:
    explicit LineTransform(std::int32_t longest)
        : in_(static_cast<std::size_t>(longest)), at_(in_.size()), from_(in_.size() + 1) {}

    void run(float* line, std::size_t stride, std::int32_t n) {
        for (std::int32_t i = 0; i < n; ++i)
            in_[static_cast<std::size_t>(i)] = line[static_cast<std::size_t>(i) * stride];
        constexpr double infinity = std::numeric_limits<double>::infinity();
        std::size_t top = 0;
        at_[0] = 0;
        from_[0] = -infinity;
        for (std::int32_t q = 1; q < n; ++q) {
            double start = crossing(q, at_[top]);
            while (top > 0 && start <= from_[top]) start = crossing(q, at_[--top]);
            at_[++top] = q;
            from_[top] = start;
        }
        from_[top + 1] = infinity;
        std::size_t k = 0;
        for (std::int32_t q = 0; q < n; ++q) {
            while (from_[k + 1] < q) ++k;
            const double away = q - at_[k];
            line[static_cast<std::size_t>(q) * stride] =
                static_cast<float>(away * away + in_[static_cast<std::size_t>(at_[k])]);
        }
    }

private:
    double crossing(double q, double p) const {
        return 0.5 * ((in_[static_cast<std::size_t>(q)] - in_[static_cast<std::size_t>(p)]) / (q - p) + q + p);
    }

    std::vector<double> in_;
    std::vector<std::int32_t> at_;
    std::vector<double> from_;
};

// Squared distances between centres, in cells, from each cell to the nearest that may hold surface.
std::vector<float> squaredCellDistances(const Grid& grid, const std::vector<float>& distances, double half_diagonal,
                                        int threads) {
    constexpr float far = 4e6f;  // beyond the square of any distance in the grid
    std::vector<float> squares(grid.size());
    for (std::size_t i = 0; i < squares.size(); ++i)
        squares[i] = static_cast<double>(distances[i]) <= half_diagonal ? 0 : far;
    const std::int32_t longest = std::max({grid.nx, grid.ny, grid.nz});
    const std::size_t row = static_cast<std::size_t>(grid.nx), layer = row * static_cast<std::size_t>(grid.ny);
    parallelFor(static_cast<std::size_t>(grid.nz), threads, [&](std::size_t z) {
        LineTransform transform(longest);
        for (std::int32_t y = 0; y < grid.ny; ++y)
            transform.run(&squares[grid.index(0, y, static_cast<std::int32_t>(z))], 1, grid.nx);
        for (std::int32_t x = 0; x < grid.nx; ++x)
            transform.run(&squares[grid.index(x, 0, static_cast<std::int32_t>(z))], row, grid.ny);
    });
    parallelFor(static_cast<std::size_t>(grid.ny), threads, [&](std::size_t y) {
        LineTransform transform(longest);
        for (std::int32_t x = 0; x < grid.nx; ++x)
            transform.run(&squares[grid.index(x, static_cast<std::int32_t>(y), 0)], layer, grid.nz);
    });
    return squares;
}

// Cells that hold no surface and are joined to the border of the grid are outside: two of them share a face, and no
// surface passes between them.
std::vector<bool> outsideOf(const Grid& grid, const std::vector<bool>& empty) {
    std::vector<bool> seen(grid.size(), false);
    std::vector<std::array<std::int32_t, 3>> front;
    const auto visit = [&](std::int32_t x, std::int32_t y, std::int32_t z) {
        if (x < 0 || y < 0 || z < 0 || x >= grid.nx || y >= grid.ny || z >= grid.nz) return;
        const std::size_t i = grid.index(x, y, z);
        if (seen[i] || !empty[i]) return;
        seen[i] = true;
        front.push_back({x, y, z});
    };
    visit(0, 0, 0);
    while (!front.empty()) {
        const auto [x, y, z] = front.back();
        front.pop_back();
        visit(x - 1, y, z), visit(x + 1, y, z);
        visit(x, y - 1, z), visit(x, y + 1, z);
        visit(x, y, z - 1), visit(x, y, z + 1);
    }
    return seen;
}

}  // namespace

float DistanceBounds::at(Vec3f p) const {
    const auto cellOf = [this](float position, float low) {
        return static_cast<std::int32_t>(std::floor((position - low) / cell_mm));
    };
    const std::int32_t x = cellOf(p.x, origin.x), y = cellOf(p.y, origin.y), z = cellOf(p.z, origin.z);
    if (x < 0 || y < 0 || z < 0 || x >= nx || y >= ny || z >= nz) return 0;
    return unit_mm * static_cast<float>(values[(static_cast<std::size_t>(z) * ny + y) * nx + x]);
}

// [Ericson2005] section 5.1.5: the Voronoi regions of corners, edges and face.
double squaredDistance(Vec3 p, Vec3 a, Vec3 b, Vec3 c) {
    const Vec3 ab = b - a, ac = c - a, ap = p - a;
    const auto squareTo = [&](Vec3 q) { return dot(p - q, p - q); };
    const double d1 = dot(ab, ap), d2 = dot(ac, ap);
    if (d1 <= 0 && d2 <= 0) return squareTo(a);
    const Vec3 bp = p - b;
    const double d3 = dot(ab, bp), d4 = dot(ac, bp);
    if (d3 >= 0 && d4 <= d3) return squareTo(b);
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return squareTo(a + (d1 - d3 > 0 ? d1 / (d1 - d3) : 0) * ab);
    const Vec3 cp = p - c;
    const double d5 = dot(ab, cp), d6 = dot(ac, cp);
    if (d6 >= 0 && d5 <= d6) return squareTo(c);
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return squareTo(a + (d2 - d6 > 0 ? d2 / (d2 - d6) : 0) * ac);
    const double va = d3 * d6 - d5 * d4, from_b = d4 - d3, from_c = d5 - d6;
    if (va <= 0 && from_b >= 0 && from_c >= 0) {
        const double along = from_b + from_c;
        return squareTo(b + (along > 0 ? from_b / along : 0) * (c - b));
    }
    const double all = va + vb + vc;
    return squareTo(a + (vb / all) * ab + (vc / all) * ac);
}

DistanceBounds buildDistanceBounds(const Mesh& mesh, double cell_mm, double reach_mm, int threads) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Vec3 low{infinity, infinity, infinity}, high{-infinity, -infinity, -infinity};
    for (const auto& triangle : mesh.triangles)
        for (const std::uint32_t v : triangle) {
            const Vec3 p = toDouble(mesh.positions[v]);
            low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
            high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
        }
    const Vec3 extent = high - low;
    Grid grid;
    grid.cell = std::max(cell_mm, std::max({extent.x, extent.y, extent.z}) / (kMostCells - 4));
    // Two cells around the mesh: the outermost are empty, so that the outside is in one piece.
    const double beyond = 2 * grid.cell;
    grid.origin = toDouble(toFloat(low - Vec3{beyond, beyond, beyond}));
    const auto cellsAlong = [&](double length) { return static_cast<std::int32_t>(std::ceil(length / grid.cell)) + 4; };
    grid.nx = cellsAlong(extent.x), grid.ny = cellsAlong(extent.y), grid.nz = cellsAlong(extent.z);

    const double half_diagonal = 0.5 * std::sqrt(3.0) * grid.cell;
    const double reach = std::max(reach_mm, 1.01 * half_diagonal);
    const std::vector<float> distances = nearDistances(mesh, grid, reach, threads);
    const std::vector<float> squares = squaredCellDistances(grid, distances, half_diagonal, threads);

    // 8 steps a cell lose 6 % of a cell on average; what is beyond 32 cells needs no number.
    const double unit = grid.cell / 8;
    DistanceBounds bounds{toFloat(grid.origin),    static_cast<float>(grid.cell), grid.nx, grid.ny, grid.nz,
                          static_cast<float>(unit)};
    bounds.values.assign(grid.size(), 0);
    std::vector<bool> empty(grid.size());
    for (std::size_t i = 0; i < grid.size(); ++i) {
        const double to_centre = std::max(static_cast<double>(distances[i]),
                                          std::sqrt(static_cast<double>(squares[i])) * grid.cell - half_diagonal);
        const double bound = to_centre - half_diagonal - kMargin * grid.cell;
        empty[i] = bound > 0;
        bounds.values[i] = static_cast<std::uint8_t>(std::clamp(std::floor(bound / unit), 0.0, 255.0));
    }
    bounds.outside = outsideOf(grid, empty);
    for (std::size_t i = 0; i < grid.size(); ++i)
        if (bounds.outside[i]) bounds.values[i] = 0;
    return bounds;
}

}  // namespace searchlight
