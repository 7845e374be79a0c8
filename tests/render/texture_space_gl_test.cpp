#include <cmath>
#include <random>

#include "gl/context.h"
#include "model/plane.h"
#include "render/renderer.h"
#include "render/texture/texture_gl.h"
#include "scene/materials.h"

namespace searchlight {
namespace {

TEST(TextureGl, ChoosesTheCellsThatPrefixSumsChoose) {
    gl::Context context;
    TextureGl device(context);
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform;
    for (const std::size_t cells : {1u, 5u, 64u, 43'000u}) {
        std::vector<double> weights(cells);
        for (double& weight : weights) weight = uniform(random) < 0.5 ? 0 : uniform(random);
        weights[cells / 2] = 1;
        std::vector<double> along;
        constexpr std::size_t n = 4000;
        for (std::size_t k = 0; k < n; ++k) along.push_back(sampleNumbers(k, n, 3).along);
        const CellChooser chooser(weights);
        const std::vector<CellChoice> found = device.choose(weights, along);
        std::size_t same = 0;
        for (std::size_t k = 0; k < n; ++k) {
            ASSERT_LT(found[k].cell, cells);
            ASSERT_GT(weights[found[k].cell], 0);
            EXPECT_NEAR(found[k].probability * chooser.total() / weights[found[k].cell], 1, 1e-4);
            same += found[k].cell == chooser.choose(along[k]).cell;
        }
        // Float numbers are 6e-8 apart near 1: that much of the range of 43,000 cells goes to a neighbour, and the
        // rounding of the sums on the way down adds as much some ten times over.
        EXPECT_GE(same, n - n / 100) << cells;
    }
}

TEST(TextureSpaceGl, GivesThePictureOfTheCpu) {
    const MaterialSource materials = [](const Scene& scene) {
        RenderMaterial material{loadModel(scene.model.id), resolveMaterial(scene.material).medium, nullptr};
        material.evaluator = makeNativeEvaluator(material.model);
        material.evaluator->set(material.medium, {});
        return material;
    };
    gl::Context context;
    Observer observer;
    Scene scene;
    scene.object = "torus_knot";
    RenderSettings settings{.width = 64,
                            .height = 48,
                            .technique = "texture-space",
                            .technique_options = {{"samples", 900.0}, {"atlas", 64.0}, {"uvs", std::string("own")}},
                            .edge_samples = 1};
    Renderer on_cpu(materials), on_gl(materials, &context);
    on_cpu.setScene(scene), on_cpu.setSettings(settings);
    settings.gl = true;
    on_gl.setScene(scene), on_gl.setSettings(settings);
    const Image one = on_cpu.render(observer), other = on_gl.render(observer);
    double errors = 0, squares = 0;
    for (std::size_t i = 0; i < one.pixels.size(); ++i) {
        if (one.pixels[i].a != 1 || other.pixels[i].a != 1) continue;  // borders are drawn each in their way
        errors += std::pow(one.pixels[i].g - other.pixels[i].g, 2);
        squares += std::pow(one.pixels[i].g, 2);
    }
    EXPECT_GT(squares, 0);
    // Few samples go to a neighbouring texel; positions of the picture differ by rounding.
    EXPECT_LT(std::sqrt(errors / squares), 0.01);
}

}  // namespace
}  // namespace searchlight
