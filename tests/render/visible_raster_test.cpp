#include "render/visible_raster.h"

#include <hwy/highway.h>

#include <cmath>
#include <map>

#include "base/error.h"
#include "instruction_sets.h"

namespace searchlight {
namespace {

Object builtIn(const std::string& name) {
    Scene scene;
    scene.object = name;
    return placeObject(scene);
}

// Large triangles without normals of their own, seen from both sides, at all distances.
Object crossedSheets() {
    Object object;
    object.mesh.positions = {{-5, -1, -5}, {5, -1, -5}, {5, -1, 5}, {-5, -1, 5}, {0, -5, -5}, {0, -5, 5}, {0, 5, 0}};
    object.mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}};
    object.longest_mm = 10;
    object.half_extent = {5, 5, 5};
    return object;
}

struct Picture {
    Object object;
    View view;
    TraceOptions options;
    VisibleSurface traced, drawn;

    Picture(Object shape, const Camera& camera, int width, int height, int edge_samples = 8)
        : object(std::move(shape)) {
        Observer quiet;
        view = makeView(camera, object, width, height);
        options.edge_samples = edge_samples;
        traced = traceVisible(view, object, RayScene(object.mesh), options, quiet);
        VisibleRaster().find(view, object, options, quiet, drawn);
    }

    // Samples by pixel, of pixels that both found to have as many.
    template <class Body>
    int compare(const Body& body) const {
        std::map<std::uint32_t, std::vector<std::size_t>> a, b;
        for (std::size_t i = 0; i < traced.pixels.size(); ++i) a[traced.pixels[i]].push_back(i);
        for (std::size_t i = 0; i < drawn.pixels.size(); ++i) b[drawn.pixels[i]].push_back(i);
        int differ = 0;
        for (const auto& [pixel, samples] : b) differ += !a.contains(pixel);
        for (const auto& [pixel, samples] : a) {
            const auto found = b.find(pixel);
            if (found == b.end() || found->second.size() != samples.size()) {
                ++differ;
                continue;
            }
            for (std::size_t k = 0; k < samples.size(); ++k) body(samples[k], found->second[k]);
        }
        return differ;
    }
};

double distance(Vec3f a, Vec3f b) { return length(toDouble(a) - toDouble(b)); }

void expectAgreement(const Picture& picture, const std::string& what) {
    const double pixel_mm = 2 * picture.view.tan_half / picture.view.height * length(picture.view.eye);
    int samples = 0, apart = 0;
    const int differ = picture.compare([&](std::size_t a, std::size_t b) {
        ++samples;
        apart += distance(picture.traced.positions[a], picture.drawn.positions[b]) > 1e-3 * pixel_mm ||
                 distance(picture.traced.normals[a], picture.drawn.normals[b]) > 1e-3 ||
                 distance(picture.traced.geometric_normals[a], picture.drawn.geometric_normals[b]) > 1e-3 ||
                 picture.traced.coverage[a] != picture.drawn.coverage[b];
    });
    ASSERT_GT(samples, 300) << what;
    // Both round, so that a ray close to an edge finds the neighbouring triangle: another patch of an edge pixel or
    // another facet's normal. At most 2 samples of a picture were seen to differ, in edge pixels that hold eight rays.
    EXPECT_LE(apart, 2e-3 * samples) << what;
    EXPECT_LE(differ, 1e-3 * samples) << what;
}

TEST(VisibleRaster, FindsWhatRaysFind) {
    for (const char* name : {"sphere", "torus_knot", "statue", "slab"})
        for (const double azimuth : {10.0, 200.0})
            expectAgreement({builtIn(name), {.azimuth_deg = azimuth, .elevation_deg = 25}, 203, 131}, name);
}

TEST(VisibleRaster, FindsWhatRaysFindFromWithinAndAcrossTheEye) {
    // Triangles that reach behind the eye are cut where it looks away from them.
    for (const double distance : {0.2, 0.7, 2.0})
        for (const double azimuth : {20.0, 130.0})
            expectAgreement(
                {crossedSheets(),
                 {.azimuth_deg = azimuth, .elevation_deg = 5, .distance = distance, .field_of_view_deg = 80},
                 150,
                 97},
                std::to_string(distance));
    expectAgreement({builtIn("sphere"), {.distance = 0.45, .field_of_view_deg = 60}, 150, 97}, "inside");
}

TEST(VisibleRaster, FindsTheSameWithShorterVectors) {
    for (const std::int64_t target : {HWY_AVX2, HWY_SSE4}) {
        if (!hasInstructionSet(target)) continue;
        hwy::SetSupportedTargetsForTest(target);
        expectAgreement({builtIn("torus_knot"), {.azimuth_deg = 40}, 203, 131}, hwy::TargetName(target));
        expectAgreement({crossedSheets(), {.distance = 0.7, .field_of_view_deg = 80}, 150, 97},
                        hwy::TargetName(target));
        hwy::SetSupportedTargetsForTest(0);
    }
}

TEST(VisibleRaster, LeavesNoPixelOpenBetweenTriangles) {
    // A sphere that covers the picture: any hole would be at the crossing of edges with centres or edge samples.
    const Picture picture(builtIn("sphere"), {.distance = 0.9}, 640, 480);
    ASSERT_EQ(picture.drawn.pixels.size(), 640u * 480u);
    for (const float coverage : picture.drawn.coverage) ASSERT_EQ(coverage, 1);
}

TEST(VisibleRaster, TakesAnyNumberOfEdgeSamples) {
    for (const int edge_samples : {1, 3, 8, 21})
        expectAgreement({builtIn("torus_knot"), {}, 150, 97, edge_samples}, std::to_string(edge_samples));
}

TEST(VisibleRaster, DependsNeitherOnThreadsNorOnThePictureBefore) {
    const Object knot = builtIn("torus_knot"), sphere = builtIn("sphere");
    Observer quiet;
    VisibleRaster kept;
    VisibleSurface again, fresh;
    const View before = makeView({}, sphere, 300, 200), view = makeView({.azimuth_deg = 70}, knot, 190, 130);
    kept.find(before, sphere, {.threads = 1}, quiet, again);
    kept.find(view, knot, {.threads = 1}, quiet, again);
    VisibleRaster().find(view, knot, {.threads = 2}, quiet, fresh);
    EXPECT_EQ(again.pixels, fresh.pixels);
    EXPECT_EQ(again.coverage, fresh.coverage);
    EXPECT_EQ(again.positions, fresh.positions);
    EXPECT_EQ(again.normals, fresh.normals);
    EXPECT_EQ(again.geometric_normals, fresh.geometric_normals);
}

TEST(VisibleRaster, CanBeCancelled) {
    struct Impatient : Observer {
        bool cancelled() const override { return true; }
    } observer;
    const Object object = crossedSheets();
    VisibleSurface visible;
    EXPECT_THROW(VisibleRaster().find(makeView({}, object, 40, 40), object, {}, observer, visible), Error);
}

}  // namespace
}  // namespace searchlight
