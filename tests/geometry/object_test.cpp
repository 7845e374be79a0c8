#include "geometry/object.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>

#include "base/error.h"
#include "geometry/cloud_estimate.h"
#include "geometry/cloud_surface.h"
#include "geometry/mesh_report.h"
#include "geometry/surface_points.h"
#include "io/shape_file.h"

namespace searchlight {
namespace {

using testing::Contains;
using testing::HasSubstr;

Vec3f highest(const std::vector<Vec3f>& positions) {
    Vec3f high = positions[0];
    for (const Vec3f p : positions) high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    return high;
}

PointCloud pointsOn(const Mesh& mesh, std::size_t count) {
    Observer observer;
    return samplePoints(mesh, {.count = count}, observer);
}

class Files : public testing::Test {
protected:
    void SetUp() override {
        std::string name = (std::filesystem::temp_directory_path() / "searchlight-object-XXXXXX").string();
        ASSERT_NE(mkdtemp(name.data()), nullptr);
        folder_ = name;
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    Object place(const Mesh& mesh, double scale = 10) {
        const std::string path = (folder_ / "mesh.ply").string();
        writeMesh(path, mesh);
        return placeObject({.object = path, .scale = scale});
    }

    std::filesystem::path folder_;
};

TEST(PlacedObject, IsCentredAndAsLongAsTheSceneSays) {
    for (const std::string& id : builtInObjects()) {
        SCOPED_TRACE(id);
        const Object object = placeObject({.object = id, .scale = 25});
        const Vec3f high = highest(object.mesh.positions);
        EXPECT_TRUE(object.isMesh());
        EXPECT_EQ(object.longest_mm, 25);
        EXPECT_NEAR(high.x, object.half_extent.x, 1e-5);
        EXPECT_NEAR(high.y, object.half_extent.y, 1e-5);
        EXPECT_NEAR(high.z, object.half_extent.z, 1e-5);
        EXPECT_NEAR(std::max({high.x, high.y, high.z}), 12.5, 1e-5);
        EXPECT_EQ(object.mesh.normals.size(), object.mesh.positions.size());
        EXPECT_TRUE(object.notes.empty());
    }
}

TEST(PlacedObject, HashIsOfTheShapeInMillimetres) {
    const Object a = placeObject({.object = "sphere", .scale = 10}), b = placeObject({.object = "sphere", .scale = 10}),
                 c = placeObject({.object = "sphere", .scale = 11}), d = placeObject({.object = "slab", .scale = 10});
    EXPECT_EQ(a.content_hash.size(), 32u);
    EXPECT_EQ(a.content_hash, b.content_hash);
    EXPECT_NE(a.content_hash, c.content_hash);
    EXPECT_NE(a.content_hash, d.content_hash);
}

TEST(PlacedObject, UnknownNamesAreAnswered) {
    EXPECT_THROW(builtInObject("bunny"), Error);
    try {
        builtInObject("statu");
    } catch (const Error& error) {
        EXPECT_THAT(error.what(), HasSubstr("statue"));
    }
}

TEST_F(Files, FaultsBecomeNotes) {
    Mesh mesh = builtInObject("sphere", -2);
    mesh.normals.clear();
    mesh.triangles.pop_back();
    mesh.positions.push_back({100, 0, 0});
    mesh.uvs.clear();
    const Object object = place(mesh);
    EXPECT_NEAR(object.half_extent.x, 5, 1e-5);
    EXPECT_THAT(object.notes, Contains("2 vertices that no triangle uses are left out"));
    EXPECT_THAT(object.notes, Contains("3 edges are open"));
    EXPECT_THAT(object.notes, Contains(HasSubstr("normals are the means")));
    for (std::size_t i = 0; i < object.mesh.positions.size(); ++i)
        ASSERT_GT(dot(toDouble(object.mesh.normals[i]), toDouble(object.mesh.positions[i])) / 5, 0.99);
}

TEST_F(Files, MeshThatIsInsideOutIsTurned) {
    Mesh mesh = builtInObject("torus_knot", -2);
    mesh.normals.clear();
    for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
    const Object object = place(mesh);
    EXPECT_GT(reportMesh(object.mesh).volume, 0);
    EXPECT_EQ(reportMesh(object.mesh).opposed_normals, 0u);
    EXPECT_THAT(object.notes, Contains("so the mesh was turned inside out"));
}

TEST_F(Files, ShapeWithoutExtentIsAnError) {
    Mesh point;
    point.positions.assign(3, {1, 2, 3});
    point.triangles = {{0, 1, 2}};
    EXPECT_THROW(place(point), Error);
}

TEST_F(Files, CloudWithoutNormalsAndAreasIsCompletedAndSeen) {
    const std::string path = (folder_ / "cloud.ply").string();
    PointCloud bare;
    bare.positions = pointsOn(builtInObject("sphere"), 20'000).positions;
    writePointCloud(path, bare);
    const Object object = placeObject({.object = path, .scale = 10});
    ASSERT_EQ(object.cloud.normals.size(), 20'000u);
    EXPECT_FALSE(object.isMesh());
    for (std::size_t i = 0; i < object.cloud.positions.size(); ++i)
        ASSERT_GT(dot(toDouble(object.cloud.normals[i]), toDouble(object.cloud.positions[i])) / 5, 0.995);
    const double area = std::accumulate(object.cloud.areas.begin(), object.cloud.areas.end(), 0.0);
    // 314.16 mm^2; the estimate assumes independent points, and blue noise is more even: 0.7 % low.
    EXPECT_NEAR(area / 314.16, 1, 0.02);
    const MeshReport report = reportMesh(object.mesh);
    EXPECT_TRUE(report.closed);
    EXPECT_EQ(report.genus(), 0);
    EXPECT_EQ(report.components, 1u);
    // 523.6 mm^3. Planes through points bulge by a fraction of spacing^2 / 2 radius = 0.0016 mm.
    EXPECT_NEAR(report.volume / 523.6, 1, 2e-3);
    EXPECT_NEAR(report.area / 314.16, 1, 2e-3);
}

// A shape with thin ears, a plinth with edges and folds. The file's own normals are the truth.
TEST(CloudEstimate, NormalsOfTheStatuePointOutward) {
    const PointCloud truth = pointsOn(builtInObject("statue"), 60'000);
    const std::vector<Vec3f> normals = estimateNormals(truth.positions);
    std::size_t outward = 0;
    for (std::size_t i = 0; i < normals.size(); ++i)
        outward += dot(toDouble(normals[i]), toDouble(truth.normals[i])) > 0;
    EXPECT_GT(static_cast<double>(outward) / 60'000, 0.99);
}

TEST(CloudSurface, StatueComesBackClosed) {
    const Mesh statue = builtInObject("statue");
    const Mesh again = surfaceThrough(pointsOn(statue, 100'000));
    const MeshReport expected = reportMesh(statue), report = reportMesh(again);
    EXPECT_TRUE(report.closed) << testing::PrintToString(faultsOf(report));
    EXPECT_NEAR(report.volume / expected.volume, 1, 0.02);
    EXPECT_NEAR(report.area / expected.area, 1, 0.05);
}

}  // namespace
}  // namespace searchlight
