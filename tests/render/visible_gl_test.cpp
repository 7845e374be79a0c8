#include "render/visible_gl.h"

#include <gtest/gtest.h>

#include <map>

#include "gl/context.h"

namespace searchlight {
namespace {

struct Picture {
    Scene scene;
    Object object;
    RayScene rays;
    View view;
    Observer observer;

    Picture(std::string object_id, Camera camera, int width, int height)
        : scene{.object = std::move(object_id)},
          object(placeObject(scene)),
          rays(object.mesh),
          view(makeView(camera, object, width, height)) {}
};

TEST(VisibleGl, CentresAgreeWithRays) {
    gl::Context context;
    for (const char* id : {"sphere", "torus_knot"}) {
        Picture picture(id, {}, 96, 64);
        const TraceOptions options{.edge_samples = 1, .threads = 1};
        const VisibleSurface traced =
            traceVisible(picture.view, picture.object, picture.rays, options, picture.observer);
        const VisibleSurface found =
            VisibleGl(context, picture.object).visible(picture.view, options, picture.observer);
        EXPECT_EQ(found.width, 96);
        EXPECT_EQ(found.height, 64);
        std::map<std::uint32_t, std::size_t> by_pixel;
        for (std::size_t i = 0; i < traced.pixels.size(); ++i) by_pixel[traced.pixels[i]] = i;
        std::size_t same = 0;
        for (std::size_t i = 0; i < found.pixels.size(); ++i) {
            const auto there = by_pixel.find(found.pixels[i]);
            if (there == by_pixel.end()) continue;
            const std::size_t k = there->second;
            // Rays that meet the outline of a triangle may take its neighbour: the same place all the same.
            if (length(toDouble(found.positions[i]) - toDouble(traced.positions[k])) > 1e-3) continue;
            if (length(toDouble(found.normals[i]) - toDouble(traced.normals[k])) > 1e-3) continue;
            ++same;
        }
        // A rasteriser's places are rounded to 1/256 of a pixel, which decides at outlines only.
        EXPECT_GT(traced.pixels.size(), 500u);
        EXPECT_NEAR(static_cast<double>(found.pixels.size()), static_cast<double>(traced.pixels.size()), 4);
        EXPECT_GE(same + 6, traced.pixels.size()) << id;
    }
}

TEST(VisibleGl, EdgesAreCoveredAlike) {
    gl::Context context;
    Picture picture("torus_knot", {}, 80, 80);
    const TraceOptions options{.edge_samples = 8, .threads = 1};
    const auto coverage = [](const VisibleSurface& surface) {
        std::vector<double> sums(6400);
        for (std::size_t i = 0; i < surface.pixels.size(); ++i) sums[surface.pixels[i]] += surface.coverage[i];
        return sums;
    };
    const std::vector<double> traced =
        coverage(traceVisible(picture.view, picture.object, picture.rays, options, picture.observer));
    const std::vector<double> found =
        coverage(VisibleGl(context, picture.object).visible(picture.view, options, picture.observer));
    double difference = 0;
    std::size_t partial = 0;
    for (std::size_t i = 0; i < traced.size(); ++i) {
        difference += std::abs(found[i] - traced[i]);
        partial += traced[i] > 0 && traced[i] < 1 ? 1 : 0;
    }
    EXPECT_GT(partial, 100u);
    // One of eight samples in fifty edge pixels.
    EXPECT_LT(difference, static_cast<double>(partial) / 8 / 50 + 0.25);
}

TEST(VisibleGl, CloseUpFillsThePicture) {
    gl::Context context;
    Picture picture("sphere", {.distance = 0.7}, 32, 48);
    const VisibleSurface found =
        VisibleGl(context, picture.object).visible(picture.view, {.edge_samples = 1}, picture.observer);
    EXPECT_EQ(found.pixels.size(), 32u * 48u);
    EXPECT_EQ(found.eye.z, picture.view.eye.z);
}

}  // namespace
}  // namespace searchlight
