#include "transport/mesh/triangle_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "geometry/vertex_normals.h"
#include "transport/mesh/facet_geometry.h"

namespace searchlight {

namespace {

// Of a cell, that triangles are looked for around it: positions in the grid are rounded to 1e-5 of a cell.
constexpr double kMargin = 1e-3;
constexpr double kMostAlong = 256;
constexpr double kNormal = 511;  // length of a normal of three components of 10 bits, about

// Which cells a triangle touches: planes and edges of [SchwarzSeidel2010], in units of cells.
class Touch {
public:
    explicit Touch(const std::array<Vec3, 3>& corners) {
        const auto& [a, b, c] = corners;
        const Vec3 n = cross(b - a, c - a);
        normal_ = n;
        plane_ = dot(n, a);
        reach_ = (0.5 + kMargin) * (std::abs(n.x) + std::abs(n.y) + std::abs(n.z));
        const auto project = [&](Projection along, double height) {
            const double sign = height >= 0 ? 1 : -1;
            for (std::size_t i = 0; i < 3; ++i) {
                const auto [p, q] = along(corners[i]);
                const auto [to_p, to_q] = along(corners[(i + 1) % 3]);
                // Inward in the projection.
                const double np = sign * (q - to_q), nq = sign * (to_p - p);
                edges_.push_back({along, np, nq, np * p + nq * q - (0.5 + kMargin) * (std::abs(np) + std::abs(nq))});
            }
        };
        project([](const Vec3& v) { return std::pair(v.y, v.z); }, n.x);
        project([](const Vec3& v) { return std::pair(v.z, v.x); }, n.y);
        project([](const Vec3& v) { return std::pair(v.x, v.y); }, n.z);
    }

    bool cellAt(Vec3 middle) const {
        if (std::abs(dot(normal_, middle) - plane_) > reach_) return false;
        return std::ranges::all_of(edges_, [&](const Edge& edge) {
            const auto [p, q] = edge.along(middle);
            return edge.p * p + edge.q * q >= edge.least;
        });
    }

private:
    using Projection = std::pair<double, double> (*)(const Vec3&);
    struct Edge {
        Projection along;
        double p, q, least;
    };
    Vec3 normal_;
    double plane_, reach_;
    std::vector<Edge> edges_;
};

// The least of n . p over what of a triangle lies in a cube [Sutherland1974]; over all of it when nothing does.
double lowestInside(const std::array<Vec3, 3>& triangle, Vec3 n, Vec3 middle, double half) {
    std::array<Vec3, 9> polygon, cut;  // each side of the cube adds a corner at most
    std::size_t corners = 3;
    std::ranges::copy(triangle, polygon.begin());
    for (double Vec3::*axis : {&Vec3::x, &Vec3::y, &Vec3::z})
        for (const double side : {-1.0, 1.0}) {
            const auto inside = [&](const Vec3& p) { return half - side * (p.*axis - middle.*axis); };
            std::size_t left = 0;
            for (std::size_t i = 0; i < corners; ++i) {
                const Vec3 &p = polygon[i], &q = polygon[(i + 1) % corners];
                const double a = inside(p), b = inside(q);
                if (a >= 0) cut[left++] = p;
                if ((a >= 0) != (b >= 0)) cut[left++] = p + (a / (a - b)) * (q - p);
            }
            polygon = cut;
            corners = left;
            if (corners == 0) return std::min({dot(n, triangle[0]), dot(n, triangle[1]), dot(n, triangle[2])});
        }
    double lowest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < corners; ++i) lowest = std::min(lowest, dot(n, polygon[i]));
    return lowest;
}

// Triangles in as many blocks as they need: a block is full when it has no place for a triangle or for its vertices.
void appendBlocks(const Mesh& mesh, std::span<const std::uint32_t> triangles, TriangleGrid& grid) {
    std::size_t count = 0, vertices = 0;
    TriangleGrid::Block block;
    const auto close = [&] {
        for (std::size_t i = count; i < TriangleGrid::kBlock; ++i)
            for (std::size_t k = 0; k < 3; ++k) {
                block.corners[k][i] = block.corners[k][0];
                block.numbers[k][i] = block.numbers[k][0];
            }
        grid.blocks.push_back(block);
        block = {};
        count = vertices = 0;
    };
    // The place of a vertex in the block; behind the last one if it is new.
    const auto placeOf = [&](Vec3f p) {
        std::size_t v = 0;
        while (v < vertices && !(Vec3f{block.x[v], block.y[v], block.z[v]} == p)) ++v;
        return v;
    };
    for (const std::uint32_t t : triangles) {
        std::array<Vec3f, 3> corners;
        for (std::size_t k = 0; k < 3; ++k) corners[k] = mesh.positions[mesh.triangles[t][k]];
        const auto added = std::ranges::count_if(corners, [&](Vec3f p) { return placeOf(p) == vertices; });
        if (count == TriangleGrid::kBlock || vertices + static_cast<std::size_t>(added) > TriangleGrid::kVertices)
            close();
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3f p = corners[k];
            const std::size_t v = placeOf(p);
            if (v == vertices) block.x[v] = p.x, block.y[v] = p.y, block.z[v] = p.z, ++vertices;
            block.corners[k][count] = static_cast<std::uint8_t>(v);
            block.numbers[k][count] = static_cast<std::uint8_t>(t >> 8 * k);
        }
        ++count;
    }
    if (count > 0) close();
}

}  // namespace

double gridCell(const Mesh& mesh, double area_mm2, double mfp_mm) {
    // Measured on scanned meshes (docs/benchmarks.md): finer cells hold copies of more triangles than the cache does.
    const double triangle = std::sqrt(area_mm2 / static_cast<double>(mesh.triangles.size()));
    return std::max(1.4 * triangle, 0.5 * mfp_mm);
}

TriangleGrid buildTriangleGrid(const Mesh& mesh, double cell_mm) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Vec3 low{infinity, infinity, infinity}, high{-infinity, -infinity, -infinity};
    for (const auto& triangle : mesh.triangles)
        for (const std::uint32_t v : triangle) {
            const Vec3 p = toDouble(mesh.positions[v]);
            low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
            high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
        }
    const Vec3 extent = high - low;
    TriangleGrid grid;
    grid.cell_mm = static_cast<float>(std::max(cell_mm, std::max({extent.x, extent.y, extent.z}) / kMostAlong));
    const double cell = static_cast<double>(grid.cell_mm);
    // A cell and a half around: flights that end beyond it have left.
    grid.origin = toFloat(low - 1.5 * cell * Vec3{1, 1, 1});
    const auto along = [cell](double length) { return (static_cast<std::int32_t>(length / cell + 3) / 4 + 1) * 4; };
    grid.nx = along(extent.x), grid.ny = along(extent.y), grid.nz = along(extent.z);
    const Vec3 origin = toDouble(grid.origin);

    // Cells of a brick follow one another.
    const auto indexOf = [&grid](std::int32_t x, std::int32_t y, std::int32_t z) {
        const auto brick = (static_cast<std::size_t>(z >> 2) * (grid.ny >> 2) + (y >> 2)) * (grid.nx >> 2) + (x >> 2);
        return brick << 6 | static_cast<std::size_t>((z & 3) << 4 | (y & 3) << 2 | (x & 3));
    };
    const auto cellAt = [&grid](std::size_t index) {
        const std::size_t bricks_x = static_cast<std::size_t>(grid.nx >> 2),
                          bricks_y = static_cast<std::size_t>(grid.ny >> 2);
        const std::size_t brick = index >> 6, rows = brick / bricks_x;
        return std::array{static_cast<double>(brick % bricks_x << 2 | (index & 3)),
                          static_cast<double>(rows % bricks_y << 2 | (index >> 2 & 3)),
                          static_cast<double>(rows / bricks_y << 2 | (index >> 4 & 3))};
    };
    const auto forEachCell = [&](std::size_t t, const auto& visit) {
        std::array<Vec3, 3> corners;
        Vec3 least{infinity, infinity, infinity}, most{-infinity, -infinity, -infinity};
        for (int i = 0; i < 3; ++i) {
            const Vec3 p = (1 / cell) * (toDouble(mesh.positions[mesh.triangles[t][i]]) - origin);
            corners[i] = p;
            least = {std::min(least.x, p.x), std::min(least.y, p.y), std::min(least.z, p.z)};
            most = {std::max(most.x, p.x), std::max(most.y, p.y), std::max(most.z, p.z)};
        }
        const Touch touch(corners);
        const auto cellOf = [](double x, std::int32_t n) {
            return std::clamp(static_cast<std::int32_t>(std::floor(x)), 0, n - 1);
        };
        for (std::int32_t z = cellOf(least.z - kMargin, grid.nz); z <= cellOf(most.z + kMargin, grid.nz); ++z)
            for (std::int32_t y = cellOf(least.y - kMargin, grid.ny); y <= cellOf(most.y + kMargin, grid.ny); ++y)
                for (std::int32_t x = cellOf(least.x - kMargin, grid.nx); x <= cellOf(most.x + kMargin, grid.nx); ++x)
                    if (touch.cellAt({x + 0.5, y + 0.5, z + 0.5})) visit(indexOf(x, y, z));
    };
    std::vector<std::uint32_t> count(static_cast<std::size_t>(grid.nx) * grid.ny * grid.nz);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) forEachCell(t, [&](std::size_t at) { ++count[at]; });
    grid.bricks.resize(count.size() / 64);
    std::vector<std::uint32_t> first, listed;  // of each full cell's triangles
    std::uint32_t total = 0;
    for (std::size_t at = 0; at < count.size(); ++at) {
        TriangleGrid::Brick& brick = grid.bricks[at / 64];
        const std::size_t half = at % 64 / 32;
        if (at % 32 == 0) brick.begin[half] = static_cast<std::uint32_t>(grid.cells.size());
        if (count[at] == 0) continue;
        brick.full[half] |= std::uint32_t{1} << at % 32;
        grid.cells.push_back({});
        first.push_back(total);
        total += count[at];
    }
    const auto placeOf = [&grid](std::size_t at) { return grid.bricks[at / 64].placeOf(at % 64); };
    listed.resize(total);
    std::vector<std::uint32_t> next = first;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        forEachCell(t, [&](std::size_t at) { listed[next[placeOf(at)]++] = static_cast<std::uint32_t>(t); });
    for (std::size_t i = 0; i < grid.cells.size(); ++i) {
        TriangleGrid::Cell& cell_of = grid.cells[i];
        cell_of.block = static_cast<std::uint32_t>(grid.blocks.size());
        appendBlocks(mesh, std::span(listed).subspan(first[i], next[i] - first[i]), grid);
        cell_of.blocks = static_cast<std::uint32_t>(grid.blocks.size()) - cell_of.block;
    }
    // A plane for each cell, below which a flight through it meets nothing.
    std::vector<Vec3> normals(grid.cells.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        forEachCell(t, [&](std::size_t at) {
            Vec3& normal = normals[placeOf(at)];
            normal = normal + triangleNormal(mesh, t);
        });
    for (std::size_t i = 0; i < normals.size(); ++i) {
        const Vec3 n = length(normals[i]) > 0 ? normalize(normals[i]) : Vec3{0, 0, 1};
        normals[i] = {std::round(kNormal * n.x), std::round(kNormal * n.y), std::round(kNormal * n.z)};
        const auto bits = [](double x) { return static_cast<std::uint32_t>(static_cast<std::int32_t>(x)) & 0x3FF; };
        grid.cells[i].normal = bits(normals[i].x) << 22 | bits(normals[i].y) << 12 | bits(normals[i].z) << 2;
        grid.cells[i].least = std::numeric_limits<float>::max();
    }
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        forEachCell(t, [&](std::size_t at) {
            const std::size_t place = placeOf(at);
            const auto [x, y, z] = cellAt(at);
            const Vec3 middle = origin + cell * Vec3{x + 0.5, y + 0.5, z + 0.5};
            const double least = lowestInside(cornersOf(mesh, t), normals[place], middle, (0.5 + 2 * kMargin) * cell) -
                                 kNormal * kMargin * cell;
            grid.cells[place].least = std::min(grid.cells[place].least, static_cast<float>(least));
        });
    return grid;
}

}  // namespace searchlight
