#include "light/irradiance_gl.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>

#include "base/files.h"
#include "geometry/surface_points.h"
#include "gl/context.h"
#include "light/lit_points_gl.h"

namespace searchlight {
namespace {

// A knot that shadows itself, and points on it.
struct Stage {
    Observer observer;
    Scene scene;
    Object object;
    PointCloud cloud;
    LitPoints points;
    RayScene rays;
    IrradianceOptions options;

    explicit Stage(std::string object_id = "torus_knot", std::size_t count = 5000)
        : scene{.object = std::move(object_id)},
          object(placeObject(scene)),
          cloud(samplePoints(object.mesh, {.count = count, .threads = 1}, observer)),
          points(prepareLitPoints({cloud.positions, cloud.normals}, object, nullptr, LitNormals::shading, 1, observer)),
          rays(object.mesh) {
        points = prepareLitPoints({cloud.positions, cloud.normals}, object, &rays, LitNormals::shading, 1, observer);
        options.threads = 1;
    }

    Irradiance exact(bool shadows = true) {
        return computeIrradiance(points, scene, object, shadows ? &rays : nullptr, options, observer);
    }
    Irradiance onGl(gl::Context& context, bool shadows = true) {
        return computeIrradianceGl(context, points, scene, object, shadows, options, observer);
    }
};

struct Difference {
    double largest = 0;  // of a point, relative to the brightest
    double mean = 0;     // of all points' amounts, relative to the mean
    double shadow = 0;   // fraction of points that differ by more than a third of the brightest
    double total = 0;    // of the sums, relative
};

Difference compare(std::span<const Rgbf> exact, std::span<const Rgbf> found) {
    double brightest = 0, sum = 0, sum_found = 0;
    for (std::size_t i = 0; i < exact.size(); ++i) {
        brightest = std::max<double>(brightest, exact[i].g);
        sum += exact[i].g;
        sum_found += found[i].g;
    }
    Difference d;
    for (std::size_t i = 0; i < exact.size(); ++i) {
        const double difference = std::abs(found[i].g - exact[i].g);
        d.largest = std::max(d.largest, difference / brightest);
        d.mean += difference / sum;
        d.shadow += difference > brightest / 3 ? 1.0 / static_cast<double>(exact.size()) : 0;
    }
    d.total = std::abs(sum_found - sum) / sum;
    return d;
}

TEST(IrradianceGl, UnshadowedDirectionalLightIsExact) {
    gl::Context context;
    Stage stage("torus_knot", 1000);
    stage.scene.lights = {DirectionalLight{.direction = {1, 2, 3}, .irradiance = {1, 2, 3}},
                          DirectionalLight{.direction = {-1, 0, 0}}};
    for (const double eta : {0.8, 1.0, 1.3, 2.0}) {
        stage.options.eta = eta;
        // Single precision: near grazing incidence and total reflection a difference of squares.
        EXPECT_LT(compare(stage.exact(false).transmitted, stage.onGl(context, false).transmitted).largest, 2e-5) << eta;
    }
}

TEST(IrradianceGl, ShadowMapAgreesWithRays) {
    gl::Context context;
    Stage stage;
    for (const Vec3 direction : {Vec3{1, 1, 1}, Vec3{0, 1, 0}, Vec3{-1, 0.2, 0.1}}) {
        stage.scene.lights = {DirectionalLight{.direction = direction}};
        const Irradiance exact = stage.exact(), found = stage.onGl(context);
        // The knot does shadow itself.
        EXPECT_GT(compare(stage.exact(false).transmitted, exact.transmitted).total, 0.02);
        const Difference d = compare(exact.transmitted, found.transmitted);
        // At edges of shadows, whose length times two texels holds that part of the points.
        EXPECT_LT(d.shadow, 0.005);
        EXPECT_LT(d.mean, 0.01);
        EXPECT_LT(d.total, 0.003);
    }
}

TEST(IrradianceGl, CubeMapAgreesWithRays) {
    gl::Context context;
    Stage stage;
    // Outside, close by, and in the hole of the knot.
    for (const Vec3 place : {Vec3{1, 1, 1}, Vec3{0.2, 0.6, -0.3}, Vec3{0, 0, 0}}) {
        stage.scene.lights = {PointLight{.position = place}};
        const Irradiance exact = stage.exact(), found = stage.onGl(context);
        EXPECT_LT(compare(stage.exact(false).transmitted, stage.onGl(context, false).transmitted).largest, 2e-5);
        const Difference d = compare(exact.transmitted, found.transmitted);
        EXPECT_LT(d.shadow, 0.005);
        EXPECT_LT(d.mean, 0.01);
        EXPECT_LT(d.total, 0.002);
    }
}

TEST(IrradianceGl, DiscHasPenumbras) {
    gl::Context context;
    Stage stage;
    stage.options.disc_samples = 16;
    stage.scene.lights = {DirectionalLight{.direction = {1, 1, 1}, .angle_deg = 10}};
    const Difference d = compare(stage.exact().transmitted, stage.onGl(context).transmitted);
    EXPECT_LT(d.shadow, 0.002);
    EXPECT_LT(d.mean, 0.02);
    EXPECT_LT(d.total, 0.005);
}

// A picture of 64 x 32 that is bright above, in flat Radiance RGBE.
std::string skyFile() {
    const std::string path =
        (std::filesystem::temp_directory_path() / ("searchlight_sky_" + std::to_string(getpid()) + ".hdr")).string();
    std::string text = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 32 +X 64\n";
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 64; ++x)
            text += y < 12 ? std::string("\x80\x90\xa0\x82", 4) : std::string("\x20\x10\x08\x80", 4);
    writeFile(path, text);
    return path;
}

TEST(IrradianceGl, FilterColoursTheLight) {
    gl::Context context;
    Stage stage("sphere", 1000);
    const std::string path = skyFile();
    stage.scene.lights = {DirectionalLight{.direction = {1, 0, 1}, .filter = path}};
    const Irradiance found = stage.onGl(context);
    EXPECT_LT(compare(stage.exact().transmitted, found.transmitted).mean, 0.002);
    stage.scene.lights = {DirectionalLight{.direction = {1, 0, 1}}};
    EXPECT_GT(compare(stage.exact().transmitted, found.transmitted).mean, 0.1);
    std::filesystem::remove(path);
}

TEST(IrradianceGl, OccludedEnvironmentAgreesSampleBySample) {
    gl::Context context;
    Stage stage;
    const std::string path = skyFile();
    stage.scene.lights = {EnvironmentLight{.path = path, .occlusion = true}};
    stage.options.light_samples = 32;
    // The same directions, so that only shadows differ, not the noise.
    const Difference d = compare(stage.exact().transmitted, stage.onGl(context).transmitted);
    EXPECT_LT(d.shadow, 0.001);
    EXPECT_LT(d.mean, 0.03);
    EXPECT_LT(d.total, 0.01);
    std::filesystem::remove(path);
}

TEST(IrradianceGl, UnoccludedEnvironmentIsTheCpus) {
    gl::Context context;
    Stage stage("sphere", 500);
    const std::string path = skyFile();
    stage.scene.lights = {EnvironmentLight{.path = path}, DirectionalLight{}};
    EXPECT_LT(compare(stage.exact().transmitted, stage.onGl(context).transmitted).mean, 0.01);
    std::filesystem::remove(path);
}

TEST(IrradianceGl, StepsAddUpToTheWhole) {
    gl::Context context;
    Stage stage("sphere", 200);
    const std::string path = skyFile();
    stage.scene.lights = {EnvironmentLight{.path = path, .occlusion = true}};
    stage.options.light_samples = 8;
    LitPointsGl device(context, stage.points, stage.object, true);
    ProgressiveIrradianceGl steps(device, stage.scene, stage.options, stage.observer);
    EXPECT_FALSE(steps.complete());
    EXPECT_EQ(steps.result().transmitted[0].g, 0);
    steps.step(3, stage.observer);
    steps.step(5, stage.observer);
    EXPECT_TRUE(steps.complete());
    EXPECT_EQ(steps.samples(), 8);
    EXPECT_EQ(steps.result().transmitted, stage.onGl(context).transmitted);
    std::filesystem::remove(path);
}

TEST(IrradianceGl, BeamsAddUpToWhatIsTransmitted) {
    gl::Context context;
    Stage stage("torus_knot", 500);
    stage.options.beams = true;
    stage.scene.lights = {DirectionalLight{.direction = {1, 1, 0}}, PointLight{}};
    const Irradiance found = stage.onGl(context), exact = stage.exact();
    ASSERT_EQ(found.beams.size(), 2u);
    EXPECT_EQ(found.beams[0].wi, exact.beams[0].wi);
    EXPECT_EQ(found.beams[1].wi, exact.beams[1].wi);
    for (std::size_t i = 0; i < found.transmitted.size(); ++i)
        EXPECT_FLOAT_EQ(found.transmitted[i].r, found.beams[0].flux[i].r + found.beams[1].flux[i].r);
}

TEST(IrradianceGl, EnvironmentsAreTheCpusBeams) {
    gl::Context context;
    Stage stage("torus_knot", 2000);
    const std::string path = skyFile();
    stage.options.beams = true;
    stage.options.light_samples = 32;
    for (const bool occlusion : {false, true}) {
        stage.scene.lights = {EnvironmentLight{.path = path, .occlusion = occlusion}};
        const Irradiance found = stage.onGl(context), exact = stage.exact();
        ASSERT_EQ(found.beams.size(), 17u);
        ASSERT_EQ(exact.beams.size(), 17u);
        std::vector<Rgbf> sums(found.transmitted.size());
        for (std::size_t k = 0; k < found.beams.size(); ++k) {
            EXPECT_EQ(found.beams[k].wi, exact.beams[k].wi);
            const Difference d = compare(exact.beams[k].flux, found.beams[k].flux);
            // Single precision without shadows. With them the edges of shadows, as of a directional light: 0.9 % of a
            // beam's flux at most; in the last beam, which is what the others leave, these edges are 7 %.
            EXPECT_LT(d.mean, !occlusion ? 1e-5 : k < 16 ? 0.015 : 0.1) << k;
            for (std::size_t i = 0; i < sums.size(); ++i)
                sums[i] = toFloat(toDouble(sums[i]) + toDouble(found.beams[k].flux[i]));
        }
        for (std::size_t i = 0; i < sums.size(); ++i) EXPECT_NEAR(sums[i].g, found.transmitted[i].g, 1e-5f) << i;
    }
    std::filesystem::remove(path);
}

}  // namespace
}  // namespace searchlight
