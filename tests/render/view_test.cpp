#include "render/view.h"

#include <cmath>
#include <numbers>

#include "base/error.h"

namespace searchlight {
namespace {

constexpr double degree = std::numbers::pi / 180;

Object sphere(double diameter_mm = 10) {
    Scene scene;
    scene.scale = diameter_mm;
    return placeObject(scene);
}

// A square of side 2 mm in the plane z = 0 that faces +z, without normals of its own.
Object square() {
    Object object;
    object.mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    object.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    object.longest_mm = 2;
    object.half_extent = {1, 1, 0};
    return object;
}

VisibleSurface trace(const Object& object, const View& view, int edge_samples = 8, int threads = 0) {
    Observer quiet;
    return traceVisible(view, object, RayScene(object.mesh), {.edge_samples = edge_samples, .threads = threads}, quiet);
}

double coveredPixels(const VisibleSurface& visible) {
    double sum = 0;
    for (const float coverage : visible.coverage) sum += coverage;
    return sum;
}

void expectNear(Vec3 a, Vec3 b, double tolerance = 1e-12) {
    EXPECT_NEAR(length(a - b), 0, tolerance) << a.x << " " << a.y << " " << a.z;
}

TEST(View, AzimuthTurnsFromZTowardsXAndElevationRises) {
    const Object object = square();
    Camera camera{.azimuth_deg = 0, .elevation_deg = 0, .distance = 3};
    expectNear(makeView(camera, object, 64, 48).eye, {0, 0, 6});
    camera.azimuth_deg = 90;
    expectNear(makeView(camera, object, 64, 48).eye, {6, 0, 0});
    camera.elevation_deg = 90;
    expectNear(makeView(camera, object, 64, 48).eye, {0, 6, 0});
    camera = {.azimuth_deg = 0, .elevation_deg = 0, .distance = 3, .target = {0.5, 0, 0}};
    expectNear(makeView(camera, object, 64, 48).eye, {1, 0, 6});
}

TEST(View, DirectionsSpanTheVerticalFieldOfView) {
    const Object object = square();
    const Camera camera{.azimuth_deg = 0, .elevation_deg = 0, .distance = 3, .field_of_view_deg = 40};
    const View view = makeView(camera, object, 64, 48);
    expectNear(view.direction(32, 24), {0, 0, -1});
    expectNear(view.direction(32, 0), {0, std::tan(20 * degree), -1});
    expectNear(view.direction(32 + 24, 24), {std::tan(20 * degree), 0, -1});
}

TEST(View, AFramedSphereFillsSeventyPercentOfTheHeight) {
    for (const double elevation : {0.0, 35.0}) {
        const Object object = sphere();
        const View view = makeView({.elevation_deg = elevation}, object, 160, 120);
        // The silhouette of a sphere stands where sin(angle) = radius / distance.
        const double angle = std::asin(5 / length(view.eye));
        // A framing by vertices misses the silhouette by no more than the mesh's edges are long.
        EXPECT_NEAR(std::tan(angle) / view.tan_half, 0.7, 0.002);
    }
}

TEST(View, AWideObjectIsFramedByItsWidth) {
    Object object = square();
    for (Vec3f& position : object.mesh.positions) position.y *= 0.1f;
    const View view = makeView({.azimuth_deg = 0, .elevation_deg = 0}, object, 100, 100);
    EXPECT_NEAR(1 / (view.eye.z * view.tan_half), 0.84, 1e-6);
}

TEST(TraceVisible, CoverageOfASphereIsItsDisc) {
    const Object object = sphere();
    const View view = makeView({.azimuth_deg = 0, .elevation_deg = 0}, object, 200, 160);
    const double radius = 80 * std::tan(std::asin(5 / length(view.eye))) / view.tan_half;
    const double area = std::numbers::pi * radius * radius;
    // 350 pixels of the edge with 16 strata each: an error of about 0.03 pixels each, 0.6 in all. The polyhedron is
    // smaller than the sphere by less than that.
    EXPECT_NEAR(coveredPixels(trace(object, view, 16)), area, 6);
    // One sample a pixel: 350 errors of 0.3 pixels.
    EXPECT_NEAR(coveredPixels(trace(object, view, 1)), area, 25);
}

TEST(TraceVisible, SamplesLieInTheirPixelsAndOnTheSphere) {
    const Object object = sphere();
    const View view = makeView({.azimuth_deg = 20, .elevation_deg = 30}, object, 61, 47);
    const VisibleSurface visible = trace(object, view);
    ASSERT_FALSE(visible.positions.empty());
    std::vector<double> covered(61 * 47);
    for (std::size_t i = 0; i < visible.pixels.size(); ++i) {
        const Vec3 position = toDouble(visible.positions[i]), offset = position - view.eye;
        const double depth = dot(offset, view.forward);
        const double x = 30.5 + dot(offset, view.right) / depth / (2 * view.tan_half / 47);
        const double y = 23.5 - dot(offset, view.up) / depth / (2 * view.tan_half / 47);
        EXPECT_NEAR(x, visible.pixels[i] % 61 + 0.5, 0.501);
        EXPECT_NEAR(y, visible.pixels[i] / 61 + 0.5, 0.501);
        covered[visible.pixels[i]] += visible.coverage[i];
        EXPECT_NEAR(length(position), 5, 0.01);
        // Interpolated normals of a sphere are its radii, but for the mean over an edge pixel.
        EXPECT_GT(dot(toDouble(visible.normals[i]), normalize(position)), 0.97);
        EXPECT_NEAR(length(toDouble(visible.normals[i])), 1, 1e-5);
        EXPECT_GT(dot(toDouble(visible.geometric_normals[i]), view.eye - position), 0);
    }
    for (const double coverage : covered) EXPECT_LE(coverage, 1 + 1e-6);
}

TEST(TraceVisible, DoesNotDependOnThreads) {
    const Object object = sphere();
    const View view = makeView({}, object, 90, 70);
    const VisibleSurface one = trace(object, view, 8, 1), two = trace(object, view, 8, 2);
    EXPECT_EQ(one.pixels, two.pixels);
    EXPECT_EQ(one.coverage, two.coverage);
    EXPECT_EQ(one.positions, two.positions);
    EXPECT_EQ(one.normals, two.normals);
}

TEST(TraceVisible, TheBackOfAnOpenMeshFacesTheEye) {
    const Object object = square();
    for (const double azimuth : {0.0, 180.0}) {
        const View view = makeView({.azimuth_deg = azimuth, .elevation_deg = 0, .distance = 3}, object, 40, 40);
        const VisibleSurface visible = trace(object, view);
        ASSERT_FALSE(visible.normals.empty());
        const float expected = azimuth == 0 ? 1 : -1;
        for (const Vec3f& normal : visible.normals) EXPECT_EQ(normal, (Vec3f{0, 0, expected}));
    }
}

TEST(TraceVisible, CanBeCancelled) {
    struct Impatient : Observer {
        bool cancelled() const override { return true; }
    } observer;
    const Object object = square();
    EXPECT_THROW(traceVisible(makeView({}, object, 40, 40), object, RayScene(object.mesh), {}, observer), Error);
}

}  // namespace
}  // namespace searchlight
