#include <cmath>

#include "gl/context.h"
#include "render/renderer.h"
#include "scene/materials.h"

namespace searchlight {
namespace {

TEST(RendererGl, GivesTheCpusPictureWithinTheErrorsOfBoth) {
    Observer observer;
    gl::Context context;
    Renderer renderer(
        [](const Scene& scene) {
            RenderMaterial material{loadModel(scene.model.id), resolveMaterial(scene.material).medium, nullptr};
            material.evaluator = makeNativeEvaluator(material.model);
            material.evaluator->set(material.medium, {});
            return material;
        },
        &context);
    Scene scene;
    scene.object = "torus_knot";
    scene.scale = 20;
    renderer.setScene(scene);
    RenderSettings settings{.width = 48, .height = 32, .points = 4000};
    settings.technique_options["error"] = 0.002;
    renderer.setSettings(settings);
    const Image cpu = renderer.render(observer);
    EXPECT_EQ(renderer.report().technique.device, "cpu");
    settings.gl = true;
    renderer.setSettings(settings);
    const Image gl = renderer.render(observer);
    EXPECT_NE(renderer.report().technique.device, "cpu");
    EXPECT_EQ(renderer.report()[Stage::irradiance].runs, 1u);
    double error = 0, total = 0;
    for (std::size_t i = 0; i < cpu.pixels.size(); ++i) {
        error += std::pow(cpu.pixels[i].g - gl.pixels[i].g, 2);
        total += std::pow(cpu.pixels[i].g, 2);
    }
    EXPECT_GT(total, 0);
    EXPECT_LT(std::sqrt(error / total), 0.004);
}

}  // namespace
}  // namespace searchlight
