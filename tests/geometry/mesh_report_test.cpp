#include "geometry/mesh_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "base/csv.h"
#include "base/files.h"
#include "base/text.h"
#include "geometry/object.h"
#include "io/shape_file.h"

namespace searchlight {
namespace {

using testing::ElementsAre;

Mesh cube() {
    Mesh mesh;
    for (int i = 0; i < 8; ++i)
        mesh.positions.push_back(
            {static_cast<float>(i & 1), static_cast<float>(i >> 1 & 1), static_cast<float>(i >> 2)});
    mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                      {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    return mesh;
}

TEST(MeshReport, CubeIsAClosedBodyOfVolumeOne) {
    const MeshReport report = reportMesh(cube());
    EXPECT_TRUE(report.closed);
    EXPECT_EQ(report.euler, 2);
    EXPECT_EQ(report.genus(), 0);
    EXPECT_EQ(report.components, 1u);
    EXPECT_DOUBLE_EQ(report.volume, 1);
    EXPECT_DOUBLE_EQ(report.area, 6);
    EXPECT_FALSE(report.normals);
    EXPECT_THAT(faultsOf(report), ElementsAre());
}

TEST(MeshReport, EveryFaultIsFound) {
    Mesh open = cube();
    open.triangles.pop_back();
    EXPECT_THAT(faultsOf(reportMesh(open)), ElementsAre("3 edges are open"));

    Mesh turned = cube();
    std::swap(turned.triangles[0][1], turned.triangles[0][2]);
    EXPECT_EQ(reportMesh(turned).misoriented_edges, 3u);
    EXPECT_FALSE(reportMesh(turned).closed);

    Mesh fin = cube();
    fin.positions.push_back({0.5f, -1, 0.5f});
    fin.triangles.push_back({0, 1, 8});
    EXPECT_EQ(reportMesh(fin).nonmanifold_edges, 1u);
    EXPECT_EQ(reportMesh(fin).boundary_edges, 2u);

    Mesh inside_out = cube();
    for (auto& triangle : inside_out.triangles) std::swap(triangle[1], triangle[2]);
    EXPECT_DOUBLE_EQ(reportMesh(inside_out).volume, -1);
    EXPECT_THAT(faultsOf(reportMesh(inside_out)), ElementsAre("the sides face inward"));

    Mesh messy = cube();
    messy.positions.push_back({5, 5, 5});
    messy.triangles.push_back({3, 3, 7});
    const MeshReport report = reportMesh(messy);
    EXPECT_TRUE(report.closed);
    EXPECT_EQ(report.high.x, 1);
    EXPECT_THAT(faultsOf(report), ElementsAre("1 triangle has no area", "1 vertex belongs to no triangle"));
}

TEST(MeshReport, SeamsAreNoHoles) {
    Mesh mesh = cube(), cut;
    for (const auto& triangle : mesh.triangles) {
        const auto first = static_cast<std::uint32_t>(cut.positions.size());
        for (const std::uint32_t corner : triangle) cut.positions.push_back(mesh.positions[corner]);
        cut.triangles.push_back({first, first + 1, first + 2});
    }
    const MeshReport report = reportMesh(cut);
    EXPECT_TRUE(report.closed);
    EXPECT_EQ(report.vertices, 36u);
    EXPECT_EQ(report.welded_vertices, 8u);
    EXPECT_EQ(report.euler, 2);
}

// Numbers made by another program (shared/data/meshes/mesh_table.csv), printed there to five digits.
TEST(MeshReport, AgreesWithTheTableOfScannedMeshes) {
    const std::filesystem::path folder = SEARCHLIGHT_SOURCE_DIR "/../shared/data/meshes";
    if (!std::filesystem::exists(folder / "mesh_table.csv")) GTEST_SKIP() << folder << " is not here";
    const CsvTable table = parseCsv(readFile(folder / "mesh_table.csv"), "mesh_table.csv");
    int seen = 0;
    for (const std::vector<CsvCell>& row : table.rows) {
        const auto text = [&](std::string_view name) {
            for (std::size_t i = 0; i < table.header.size(); ++i)
                if (table.header[i].text == name) return row[i].text;
            ADD_FAILURE() << "no column " << name;
            return std::string();
        };
        const auto number = [&](std::string_view name) { return parseNumber(text(name)).value_or(-1e9); };
        SCOPED_TRACE(text("file"));
        const MeshReport report = reportMesh(readMesh((folder / text("file")).string()));
        EXPECT_EQ(static_cast<double>(report.triangles), number("tris"));
        EXPECT_EQ(report.closed, text("closed") == "yes");
        EXPECT_EQ(static_cast<double>(report.boundary_edges), number("boundary_edges"));
        EXPECT_EQ(static_cast<double>(report.nonmanifold_edges), number("nonmanifold_edges"));
        EXPECT_EQ(static_cast<double>(report.misoriented_edges), number("misoriented_edges"));
        EXPECT_EQ(static_cast<double>(report.degenerate_triangles), number("degenerate_tris"));
        EXPECT_EQ(static_cast<double>(report.components), number("components"));
        EXPECT_EQ(report.uvs, text("uv") == "yes");
        EXPECT_EQ(static_cast<double>(report.euler), number("euler"));
        // A volume is only defined for a closed mesh: elsewhere it depends on the origin.
        if (report.closed) {
            EXPECT_NEAR(report.volume / number("volume"), 1, 1e-4);
        }
        EXPECT_NEAR(report.area / number("area"), 1, 1e-4);
        ++seen;
    }
    EXPECT_GE(seen, 10);
}

TEST(BuiltInObjects, AreClosedOutwardWithNormalsAndUvs) {
    const std::pair<std::string, int> genera[] = {{"sphere", 0}, {"slab", 0}, {"torus_knot", 1}};
    for (const auto& [id, genus] : genera) {
        SCOPED_TRACE(id);
        EXPECT_EQ(reportMesh(builtInObject(id)).genus(), genus);
    }
    for (const std::string& id : builtInObjects())
        for (const int detail : {-1, 0}) {
            SCOPED_TRACE(id);
            const MeshReport report = reportMesh(builtInObject(id, detail));
            EXPECT_THAT(faultsOf(report), ElementsAre());
            EXPECT_EQ(report.components, 1u);
            EXPECT_GT(report.volume, 0);
            EXPECT_TRUE(report.normals);
            EXPECT_TRUE(report.uvs);
            EXPECT_GT(report.longest(), 0.9);
            EXPECT_LT(report.longest(), 1.1);
            if (detail == 0) {
                EXPECT_GE(report.vertices, 10'000u);
                EXPECT_LE(report.vertices, 150'000u);
            }
        }
}

}  // namespace
}  // namespace searchlight
