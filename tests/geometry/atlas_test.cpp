#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <set>

#include "base/error.h"
#include "geometry/atlas/atlas.h"
#include "geometry/atlas/file_uvs.h"
#include "geometry/atlas/texel_map.h"
#include "geometry/mesh_report.h"
#include "geometry/object.h"
#include "geometry/vertex_normals.h"
#include "io/shape_file.h"

namespace searchlight {
namespace {

Observer quiet;

double areaOf(const Mesh& mesh) { return reportMesh(mesh).area; }

// Boxes glued face to face on a grid of cells: any body of cubes, its sides cut into `fine` squares. One hole through
// it per cell that is left out of a ring.
Mesh cubes(const std::set<std::array<int, 3>>& cells, int fine) {
    Mesh mesh;
    const auto quad = [&](Vec3 corner, Vec3 u, Vec3 v) {
        for (int j = 0; j < fine; ++j)
            for (int i = 0; i < fine; ++i) {
                const auto first = static_cast<std::uint32_t>(mesh.positions.size());
                for (const auto& [a, b] : {std::pair{i, j}, {i + 1, j}, {i + 1, j + 1}, {i, j + 1}})
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
            {"statue", builtInObject("statue", -1), 3},
            {"torus_knot", builtInObject("torus_knot", -1), 1},
            {"slab", builtInObject("slab", -1), 0},
            {"one hole", bodyWithHoles(1, 3), 1},
            {"two holes", bodyWithHoles(2, 3), 2},
            {"seven holes", bodyWithHoles(7, 2), 7}};
}

TEST(Atlas, IsOneToOneOnBodiesOfManyGenera) {
    for (const Case& body : bodies()) {
        SCOPED_TRACE(body.name);
        EXPECT_EQ(reportMesh(body.mesh).genus(), body.genus);
        const Atlas atlas = makeAtlas(body.mesh, {.resolution = 128, .uvs = AtlasUvs::own}, quiet);
        EXPECT_EQ(doublyCovered(atlas, 3), 0u);
        // What is asked of each chart is 1.1; the scale of all together adds a little where charts are cut for it.
        EXPECT_LT(atlas.report.stretch.l2, 1.12);
        EXPECT_LT(atlas.report.stretch.area_rms, 0.25);
        EXPECT_GT(atlas.report.fill, 0.35);
        for (const FlatTriangle& triangle : atlas.triangles)
            for (const Vec2 p : triangle) {
                EXPECT_TRUE(p.x >= 0 && p.x <= 128 && p.y >= 0 && p.y <= 128);
            }
    }
}

TEST(Atlas, DrawingFindsAnOverlapThatIsThere) {
    Atlas atlas = makeAtlas(bodyWithHoles(1, 2), {.resolution = 64}, quiet);
    atlas.triangles[3] = atlas.triangles[40];
    EXPECT_GT(doublyCovered(atlas, 3), 0u);
}

TEST(Atlas, ChartsKeepAnEmptyTexelBetweenThem) {
    const Mesh mesh = builtInObject("torus_knot", -1);
    const Atlas atlas = makeAtlas(mesh, {.resolution = 128, .uvs = AtlasUvs::own}, quiet);
    const TexelMap map = mapTexels(mesh, atlas);
    std::vector<std::uint32_t> owner(128 * 128, no_triangle);
    for (std::size_t i = 0; i < map.size(); ++i)
        owner[map.texels[i]] = atlas.charts[map.pieces[map.first_piece[i]].triangle];
    for (int y = 0; y + 1 < 128; ++y)
        for (int x = 0; x + 1 < 128; ++x) {
            const auto at = [&](int i, int j) { return owner[static_cast<std::size_t>((y + j) * 128 + x + i)]; };
            for (const std::uint32_t other : {at(1, 0), at(0, 1), at(1, 1)})
                if (at(0, 0) != no_triangle && other != no_triangle) {
                    ASSERT_EQ(at(0, 0), other) << x << ", " << y;
                }
        }
}

TEST(Atlas, OfTheBunnyIsNearlyIsometric) {
    const std::string path = SEARCHLIGHT_SOURCE_DIR "/../shared/data/meshes/bunny_7k_closed.obj";
    if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there";
    Mesh mesh = readMesh(path);
    const Atlas atlas = makeAtlas(mesh, {}, quiet);
    EXPECT_EQ(doublyCovered(atlas, 3), 0u);
    EXPECT_LT(atlas.report.stretch.l2, 1.02);
    EXPECT_LT(atlas.report.charts, 60u);
    EXPECT_TRUE(atlas.report.fault.empty());  // there are no uvs to refuse
}

TEST(Atlas, ConformalChartsAreOneToOneButKeepNoAreas) {
    const Mesh mesh = builtInObject("statue", -2);
    const Atlas rigid = makeAtlas(mesh, {.uvs = AtlasUvs::own}, quiet);
    const Atlas conformal = makeAtlas(mesh, {.conformal = true, .uvs = AtlasUvs::own}, quiet);
    EXPECT_EQ(doublyCovered(conformal, 2), 0u);
    EXPECT_LT(conformal.report.charts, rigid.report.charts);
    EXPECT_GT(conformal.report.stretch.area_rms, 3 * rigid.report.stretch.area_rms);
}

TEST(Stretch, OfKnownMapsIsKnown) {
    const std::array<Vec3, 3> surface{Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}};
    const Stretch same = stretchOf(std::vector<MappedTriangle>{{surface, {Vec2{0, 0}, Vec2{7, 0}, Vec2{0, 7}}}});
    EXPECT_NEAR(same.l2, 1, 1e-12);  // a scale of the whole is none
    EXPECT_NEAR(same.worst, 1, 1e-12);
    // Twice as wide as high: at equal areas the singular values are sqrt(2) and 1 / sqrt(2).
    const Stretch wide = stretchOf(std::vector<MappedTriangle>{{surface, {Vec2{0, 0}, Vec2{2, 0}, Vec2{0, 1}}}});
    EXPECT_NEAR(wide.l2, std::sqrt(1.25), 1e-12);
    EXPECT_NEAR(wide.worst, std::sqrt(2.0), 1e-12);
    EXPECT_NEAR(wide.area_rms, 0, 1e-12);
    const Stretch turned = stretchOf(std::vector<MappedTriangle>{{surface, {Vec2{0, 0}, Vec2{0, 1}, Vec2{1, 0}}}});
    EXPECT_TRUE(std::isinf(turned.l2));
}

TEST(TexelMap, CellsAddUpToTheSurface) {
    for (Case& body : bodies())
        for (const int resolution : {48, 256}) {
            SCOPED_TRACE(body.name);
            if (body.mesh.normals.empty()) body.mesh.normals = vertexNormals(body.mesh);
            const Atlas atlas =
                makeAtlas(body.mesh, {.resolution = resolution, .gutter = 0, .uvs = AtlasUvs::own}, quiet);
            const TexelMap map = mapTexels(body.mesh, atlas);
            double area = 0;
            for (const float cell : map.cells.areas) area += static_cast<double>(cell);
            // Areas of cells are floats.
            EXPECT_NEAR(area / areaOf(body.mesh), 1, 1e-6);
        }
}

// A plane as an atlas of itself: where a sample lies says in which texel it is.
TEST(TexelMap, SamplesLieInTheirCellsEvenly) {
    Mesh mesh{.positions = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}},
              .normals = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}},
              .uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}},
              .triangles = {{0, 1, 2}, {0, 2, 3}}};
    const Atlas atlas = makeAtlas(mesh, {.resolution = 4, .uvs = AtlasUvs::file}, quiet);
    const TexelMap map = mapTexels(mesh, atlas);
    ASSERT_EQ(map.size(), 16u);
    for (std::size_t cell = 0; cell < map.size(); ++cell) {
        const double x0 = map.texels[cell] % 4, y0 = map.texels[cell] / 4;
        constexpr int n = 32;
        double sum_x = 0, sum_y = 0, sum_xy = 0;
        for (int i = 0; i < n * n * n; ++i) {
            const SurfaceSample sample =
                sampleCell(mesh, atlas, map, cell, (i % n + 0.5) / n, (i / n % n + 0.5) / n, (i / (n * n) + 0.5) / n);
            const double x = sample.position.x - x0, y = sample.position.y - y0;
            EXPECT_TRUE(x >= -1e-6 && x <= 1 + 1e-6 && y >= -1e-6 && y <= 1 + 1e-6);
            sum_x += x, sum_y += y, sum_xy += (x - 0.5) * (y - 0.5);
        }
        // Of the midpoint rule with 32 steps along each number.
        EXPECT_NEAR(sum_x / (n * n * n), 0.5, 0.005);
        EXPECT_NEAR(sum_y / (n * n * n), 0.5, 0.005);
        EXPECT_NEAR(sum_xy / (n * n * n), 0, 0.002);
    }
}

Mesh square() {
    return {.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
            .uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}},
            .triangles = {{0, 1, 2}, {0, 2, 3}}};
}

std::string faultOf(const Mesh& mesh) { return faultOfUvs(mesh, SurfaceGraph(mesh)); }

TEST(FileUvs, AreTakenWhereSound) {
    EXPECT_EQ(faultOf(square()), "");
    const Atlas atlas = makeAtlas(square(), {.resolution = 8}, quiet);
    EXPECT_TRUE(atlas.report.from_file);
    EXPECT_EQ(atlas.report.charts, 1u);
    EXPECT_NEAR(atlas.report.stretch.l2, 1, 1e-12);
    EXPECT_NEAR(atlas.report.fill, 1, 1e-12);
}

TEST(FileUvs, OfOurOwnMakingAreSound) {
    const Mesh mesh = bodyWithHoles(2, 3);
    const Atlas atlas = makeAtlas(mesh, {}, quiet);
    const Mesh mapped = withAtlasUvs(mesh, atlas);
    EXPECT_EQ(faultOf(mapped), "");
    const Atlas again = makeAtlas(mapped, {}, quiet);
    EXPECT_TRUE(again.report.from_file);
    EXPECT_EQ(again.report.charts, atlas.report.charts);
    EXPECT_NEAR(again.report.stretch.l2, atlas.report.stretch.l2, 1e-3);
}

TEST(FileUvs, AreRefusedWithTheReason) {
    Mesh mesh = square();
    mesh.uvs.clear();
    EXPECT_EQ(faultOf(mesh), "there are none");
    mesh = square();
    mesh.uvs[2] = {1.5f, 1};
    EXPECT_EQ(faultOf(mesh), "2 of 2 triangles lie outside the unit square");
    mesh.uvs[2].x = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(faultOf(mesh), "2 of 2 triangles lie outside the unit square");
    mesh = square();
    for (Vec2f& uv : mesh.uvs) uv.x = 1 - uv.x;
    EXPECT_EQ(faultOf(mesh), "all triangles lie inside out");
    mesh = square();
    mesh.uvs[3] = {1, 0.25f};
    EXPECT_EQ(faultOf(mesh), "1 of 2 triangles are turned over");
    mesh.uvs[3] = {0, 0};
    EXPECT_EQ(faultOf(mesh), "1 of 2 triangles have no area there");
    mesh = square();  // twice the same place for two squares
    mesh.positions.insert(mesh.positions.end(), {{0, 0, 1}, {1, 0, 1}, {1, 1, 1}});
    mesh.uvs.insert(mesh.uvs.end(), {{0.1f, 0}, {1, 0}, {1, 0.9f}});
    mesh.triangles.push_back({4, 5, 6});
    EXPECT_EQ(faultOf(mesh), "triangles 0 and 2 lie over one another");
    EXPECT_THROW(makeAtlas(mesh, {.uvs = AtlasUvs::file}, quiet), Error);
    const Atlas atlas = makeAtlas(mesh, {}, quiet);
    EXPECT_FALSE(atlas.report.from_file);
    EXPECT_EQ(atlas.report.fault, "triangles 0 and 2 lie over one another");
    EXPECT_EQ(doublyCovered(atlas, 2), 0u);
}

TEST(Atlas, RefusesMeshesWithoutSurface) {
    Mesh mesh = square();
    mesh.positions[1].x = std::numeric_limits<float>::infinity();
    EXPECT_THROW(makeAtlas(mesh, {}, quiet), Error);
    mesh = square();
    for (Vec3f& p : mesh.positions) p = {p.x, 0, 0};
    EXPECT_THROW(makeAtlas(mesh, {}, quiet), Error);
    EXPECT_THROW(makeAtlas({}, {}, quiet), Error);
}

TEST(Atlas, LivesWithSliversAndLooseTriangles) {
    Mesh mesh = builtInObject("sphere", -2);
    // A triangle without area, one as thin as a hair, and one that hangs at an edge as a third.
    const auto [a, b, c] = mesh.triangles[10];
    mesh.triangles.push_back({a, a, b});
    const auto n = static_cast<std::uint32_t>(mesh.positions.size());
    const Vec3 middle = 0.5 * (toDouble(mesh.positions[a]) + toDouble(mesh.positions[b]));
    mesh.positions.push_back(toFloat(1.0001 * middle));
    mesh.positions.push_back(toFloat(2.0 * middle));
    mesh.triangles.push_back({a, b, n});
    mesh.triangles.push_back({a, b, n + 1});
    mesh.normals.clear(), mesh.uvs.clear();
    const Atlas atlas = makeAtlas(mesh, {}, quiet);
    EXPECT_EQ(doublyCovered(atlas, 3), 0u);
    EXPECT_TRUE(std::isfinite(atlas.report.stretch.l2));
}

// Both sides of a sheet, joined along its border: their triangles lie on one another.
TEST(Atlas, PartsTheSidesOfASheet) {
    Mesh mesh = square();
    mesh.uvs.clear();
    mesh.triangles.insert(mesh.triangles.end(), {{0, 2, 1}, {0, 3, 2}});
    const Atlas atlas = makeAtlas(mesh, {.resolution = 32}, quiet);
    EXPECT_EQ(doublyCovered(atlas, 3), 0u);
    EXPECT_NEAR(atlas.report.stretch.l2, 1, 1e-9);
    Mesh triangle{.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, .triangles = {{0, 1, 2}, {0, 2, 1}}};
    EXPECT_EQ(makeAtlas(triangle, {.resolution = 32}, quiet).report.charts, 2u);
}

TEST(Atlas, SaysThatItHasNoRoom) {
    try {
        makeAtlas(bodyWithHoles(7, 2), {.resolution = 4}, quiet);
        FAIL() << "16 texels are not enough for the sides of a box with seven holes";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind, ErrorKind::usage);
        EXPECT_NE(error.message.find("no room"), std::string::npos);
    }
}

}  // namespace
}  // namespace searchlight
