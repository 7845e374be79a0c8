#include "render/separable.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>

#include "base/error.h"
#include "io/image_file.h"
#include "io/shape_file.h"
#include "model/physics.h"
#include "model/plane.h"
#include "render/renderer.h"
#include "scene/materials.h"

namespace searchlight {
namespace {

MaterialSource shippedMaterials() {
    return [](const Scene& scene) {
        RenderMaterial material{loadModel(scene.model.id), resolveMaterial(scene.material).medium, nullptr};
        material.evaluator = makeNativeEvaluator(material.model);
        material.evaluator->set(material.medium, {});
        return material;
    };
}

RenderSettings small(ParamValues options = {}) {
    return {.width = 96, .height = 64, .technique = "separable", .technique_options = std::move(options)};
}

// The slab from the front, lit from there: 40 x 40 mm and 8 mm thick.
Scene slabScene() {
    Scene scene;
    scene.object = "slab";
    scene.scale = 40;
    scene.camera.azimuth_deg = scene.camera.elevation_deg = 0;
    scene.lights = {DirectionalLight{.direction = {0, 0, 1}}};
    return scene;
}

TEST(Separable, EvenLightOnASlabGivesTheTotalReflectance) {
    const Scene scene = slabScene();
    const RenderMaterial material = shippedMaterials()(scene);
    const Rgb total = tabulate(*material.evaluator, material.model, material.medium).profile.total();
    const double eta = material.medium.eta, t = 1 - Physics<double>::fresnelReflectance(1, 1 / eta);
    const double expected = t * t / (std::numbers::pi * (1 - 2 * Physics<double>::fresnelMoment(1, 1 / eta)));
    Observer observer;
    for (const char* kernel : {"preintegrated", "svd", "optimised"}) {
        Renderer renderer(shippedMaterials());
        renderer.setScene(scene);
        renderer.setSettings(small({{"kernel", std::string(kernel)}}));
        const Rgba middle = renderer.render(observer).at(48, 32);
        // Kernels have mass 1 to 1e-6; the pixel's middle is seen 0.2 degrees from the normal; floats.
        EXPECT_NEAR(middle.r, expected * total.r, 1e-4 * middle.r) << kernel;
        EXPECT_NEAR(middle.g, expected * total.g, 1e-4 * middle.g) << kernel;
        EXPECT_NEAR(middle.b, expected * total.b, 1e-4 * middle.b) << kernel;
    }
}

TEST(Separable, IsNearTheHierarchicalSumWhereTheSurfaceIsSeenAndLarge) {
    Scene scene = slabScene();
    scene.object = "sphere";
    scene.scale = 60;
    scene.lights = {DirectionalLight{.direction = {1, 0.5, 1}}};
    Observer observer;
    const auto picture = [&](const char* technique) {
        Renderer renderer(shippedMaterials());
        RenderSettings settings = small();
        settings.technique = technique;
        renderer.setScene(scene);
        renderer.setSettings(settings);
        return renderer.render(observer);
    };
    const Image separable = picture("separable"), sum = picture("hierarchical");
    double error = 0, power = 0;
    for (std::size_t i = 0; i < sum.pixels.size(); ++i) {
        error += std::pow(separable.pixels[i].g - sum.pixels[i].g, 2);
        power += std::pow(sum.pixels[i].g, 2);
    }
    // 17 taps: what docs/separable.md measures on objects of that size.
    EXPECT_LT(std::sqrt(error / power), 0.02);
}

TEST(Separable, MakesNoPointsAndKeepsWhatStays) {
    Scene scene = slabScene();
    RenderSettings settings = small();
    Renderer renderer(shippedMaterials());
    Observer observer;
    const auto runsAfter = [&](const auto& change) {
        const RenderReport before = renderer.report();
        change();
        renderer.setScene(scene);
        renderer.setSettings(settings);
        renderer.render(observer);
        std::string ran;
        for (std::size_t i = 0; i < stage_count; ++i)
            if (renderer.report().stages[i].runs > before.stages[i].runs)
                ran += std::string(stageName(static_cast<Stage>(i))) + " ";
        return ran;
    };
    EXPECT_EQ(runsAfter([] {}), "object rays material visible irradiance exitance background coat shade ");
    EXPECT_EQ(runsAfter([] {}), "");
    EXPECT_EQ(renderer.report().points, 0u);
    EXPECT_EQ(runsAfter([&] { settings.technique_options["taps"] = 25.0; }), "exitance shade ");
    EXPECT_EQ(runsAfter([&] { scene.camera.azimuth_deg = 40; }), "visible irradiance exitance background shade ");
    // Points and their light, for the techniques that sum over them; and back.
    EXPECT_EQ(runsAfter([&] {
                  settings.technique = "hierarchical";
                  settings.technique_options = {};
                  settings.points = 2000;
              }),
              "points irradiance exitance shade ");
    EXPECT_EQ(runsAfter([&] { settings.technique = "separable"; }), "irradiance exitance shade ");
}

TEST(Separable, AStrengthOfNothingShowsTheLightAsItFell) {
    const std::string path =
        (std::filesystem::temp_directory_path() / ("strength" + std::to_string(getpid()) + ".pfm")).string();
    writeImage(path, {Image(4, 4, {0, 0, 0, 1})});
    Scene scene = slabScene();
    scene.object = "torus_knot";
    Observer observer;
    const auto picture = [&](ParamValues options) {
        options["thickness"] = std::string("none");
        options["fallback"] = 1.0;
        Renderer renderer(shippedMaterials());
        renderer.setScene(scene);
        RenderSettings settings = small(std::move(options));
        settings.edge_samples = 1;  // others of a pixel at an outline see who stands for it
        renderer.setSettings(settings);
        return renderer.render(observer);
    };
    const Image without = picture({{"kernel_width", 0.0}}), black = picture({{"strength", path}}),
                blurred = picture({});
    std::filesystem::remove(path);
    const auto difference = [&](const Image& other) {
        double error = 0, power = 0;
        for (std::size_t i = 0; i < without.pixels.size(); ++i) {
            error += std::pow(other.pixels[i].r - without.pixels[i].r, 2);
            power += std::pow(without.pixels[i].r, 2);
        }
        return std::sqrt(error / power);
    };
    EXPECT_LT(difference(black), 1e-4);  // places are known to 1e-5 of a pixel
    EXPECT_GT(difference(blurred), 0.1);
}

TEST(Separable, StrengthNeedsTextureCoordinates) {
    Scene scene = slabScene();
    const std::string path =
        (std::filesystem::temp_directory_path() / ("bare" + std::to_string(getpid()) + ".obj")).string();
    {
        Mesh mesh = builtInObject("sphere", -3);
        mesh.uvs.clear();
        writeMesh(path, mesh);
    }
    scene.object = path;
    Renderer renderer(shippedMaterials());
    renderer.setScene(scene);
    renderer.setSettings(small({{"strength", std::string("none.png")}}));
    Observer observer;
    try {
        renderer.render(observer);
        ADD_FAILURE();
    } catch (const Error& error) {
        EXPECT_NE(error.message.find("has no texture coordinates, which a strength map needs"), std::string::npos);
    }
    std::filesystem::remove(path);
}

TEST(Separable, AStrengthIsALengthsFactor) {
    const std::string path =
        (std::filesystem::temp_directory_path() / ("negative" + std::to_string(getpid()) + ".pfm")).string();
    for (const float value : {-1.0f, 2000.0f, std::numeric_limits<float>::quiet_NaN()}) {
        writeImage(path, {Image(2, 2, {value, value, value, 1})});
        Renderer renderer(shippedMaterials());
        renderer.setScene(slabScene());
        renderer.setSettings(small({{"strength", path}}));
        Observer observer;
        EXPECT_THROW(renderer.render(observer), Error) << value;
    }
    std::filesystem::remove(path);
}

TEST(Separable, RankIsForMethodsThatHaveOne) {
    Renderer renderer(shippedMaterials());
    renderer.setScene(slabScene());
    renderer.setSettings(small({{"kernel", std::string("guided")}, {"rank", 2.0}}));
    Observer observer;
    EXPECT_THROW(renderer.render(observer), Error);
}

}  // namespace
}  // namespace searchlight
