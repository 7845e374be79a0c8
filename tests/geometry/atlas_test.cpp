#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>
#include <set>

#include "base/error.h"
#include "geometry/atlas/atlas.h"
#include "geometry/atlas/chart_growth.h"
#include "geometry/atlas/file_uvs.h"
#include "geometry/atlas/texel_map.h"
#include "geometry/mesh_report.h"
#include "geometry/object.h"
#include "geometry/vertex_normals.h"
#include "geometry/weld.h"
#include "gtest/gtest.h"
#include "io/shape_file.h"

namespace searchlight {
namespace {

Observer quiet;

double areaOf(const Mesh& mesh) { return reportMesh(mesh).area; }

// Boxes glued face to face on a grid of cells: any body of cubes, its sides cut into `fine` squares. One hole through it
// per cell that is left out of a ring.
Mesh cubes(const std::set<std::array<int, 3>>& cells, int fine) {
    Mesh mesh;
    const auto quad = [&](Vec3 corner, Vec3 u, Vec3 v) {
        for (int j = 0; j < fine; ++j)
            for (int i = 0; i < fine; ++i) {
                const auto first = static_cast<std::uint32_t>(mesh.positions.size());
                for (const auto [a, b] : {std::pair{i, j}, {i + 1, j}, {i + 1, j + 1}, {i, j + 1}})
                    mesh.positions.push_back(toFloat(corner + (double(a) / fine) * u + (double(b) / fine) * v));
                mesh.triangles.push_back({first, first + 1, first + 2});
                mesh.triangles.push_back({first, first + 2, first + 3});
            }
    };
    const Vec3 axes[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (const auto& [x, y, z] : cells)
        for (int axis = 0; axis < 3; ++axis)
            for (const int side : {0, 1}) {
                std::array<int, 3> beside{x, y, z};
                beside[static_cast<std::size_t>(axis)] += side == 1 ? 1 : -1;
                if (cells.contains(beside)) continue;
                const Vec3 corner = Vec3{double(x), double(y), double(z)} + double(side) * axes[axis];
                const Vec3 u = axes[(axis + 1) % 3], v = axes[(axis + 2) % 3];
                if (side == 1)
                    quad(corner, u, v);
                else
                    quad(corner, v, u);
            }
    return mesh;
}

// A slab of cells with holes at odd places in a row.
Mesh bodyWithHoles(int holes, int fine) {
    std::set<std::array<int, 3>> cells;
    for (int x = 0; x < 2 * holes + 1; ++x)
        for (int y = 0; y < 3; ++y)
            if (!(x % 2 == 1 && y == 1)) cells.insert({x, y, 0});
    return cubes(cells, fine);
}

// Texel centres that lie within more than one triangle: overlaps, found by drawing.
std::size_t doublyCovered(const Atlas& atlas, int finer) {
    const int size = atlas.resolution * finer;
    std::vector<std::uint32_t> owner(static_cast<std::size_t>(size) * size, ~0u);
    std::size_t twice = 0;
    for (std::uint32_t t = 0; t < atlas.triangles.size(); ++t) {
        if (atlas.charts[t] == no_triangle) continue;
        FlatTriangle flat = atlas.triangles[t];
        for (Vec2& p : flat) p = double(finer) * p;
        const auto [x0, x1] = std::minmax({flat[0].x, flat[1].x, flat[2].x});
        const auto [y0, y1] = std::minmax({flat[0].y, flat[1].y, flat[2].y});
        for (int y = std::max(0, int(y0)); y <= std::min(size - 1, int(y1)); ++y)
            for (int x = std::max(0, int(x0)); x <= std::min(size - 1, int(x1)); ++x) {
                const Vec2 p{x + 0.5, y + 0.5};
                bool inside = true;
                // A hair inside: a centre on a shared side belongs to one of the two.
                for (std::size_t k = 0; k < 3; ++k) inside &= cross(flat[(k + 1) % 3] - flat[k], p - flat[k]) > 1e-6;
                if (!inside) continue;
                auto& to = owner[static_cast<std::size_t>(y) * size + x];
                if (to != ~0u) ++twice;
                to = t;
            }
    }
    return twice;
}

struct Case {
    std::string name;
    Mesh mesh;
    std::int64_t genus;
};

std::vector<Case> bodies() {
    return {{"sphere", builtInObject("sphere", -1), 0},
            {"statue", builtInObject("statue", -1), 0},
            {"torus_knot", builtInObject("torus_knot", -1), 1},
            {"slab", builtInObject("slab", -1), 0},
            {"one hole", bodyWithHoles(1, 3), 1},
            {"two holes", bodyWithHoles(2, 3), 2},
            {"seven holes", bodyWithHoles(7, 2), 7}};
}

TEST(Atlas, EveryTexelOfBodiesOfManyGeneraBelongsToOneTriangle) {
    for (const Case& body : bodies()) {
        SCOPED_TRACE(body.name);
        EXPECT_EQ(reportMesh(body.mesh).genus(), body.genus);
        const Atlas atlas = makeAtlas(body.mesh, {.resolution = 128, .uvs = AtlasUvs::own}, quiet);
        EXPECT_EQ(doublyCovered(atlas, 3), 0u);
        EXPECT_LT(atlas.report.stretch.l2, 1.12);
        EXPECT_GT(atlas.report.fill, 0.4);
        RecordProperty(body.name, fmt::format("{} charts, L2 {:.3f}", atlas.report.charts, atlas.report.stretch.l2));
        fmt::print("{}: {} triangles {} charts, L2 {:.3f} Linf {:.2f} area rms {:.3f} largest {:.2f} fill {:.2f}\n", body.name,
                   body.mesh.triangles.size(), atlas.report.charts, atlas.report.stretch.l2, atlas.report.stretch.worst,
                   atlas.report.stretch.area_rms, atlas.report.stretch.largest_area, atlas.report.fill);
    }
}

}  // namespace
}  // namespace searchlight
