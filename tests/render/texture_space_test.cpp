#include <algorithm>
#include <cmath>
#include <numeric>

#include "model/plane.h"
#include "render/renderer.h"
#include "render/texture/cell_choice.h"
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

TEST(CellChooser, ChoosesInProportionToTheWeights) {
    const std::vector<double> weights{0, 3, 0, 0, 1, 4, 0};
    const CellChooser chooser(weights);
    constexpr int n = 8000;
    std::vector<int> counts(weights.size());
    for (int i = 0; i < n; ++i) {
        const CellChoice choice = chooser.choose((i + 0.5) / n);
        ++counts[choice.cell];
        EXPECT_DOUBLE_EQ(choice.probability, weights[choice.cell] / 8);
        EXPECT_TRUE(choice.inside >= 0 && choice.inside < 1);
    }
    // Numbers that are evenly spread meet each part as often as it is large, but for its ends.
    for (std::size_t c = 0; c < weights.size(); ++c) EXPECT_NEAR(counts[c], n * weights[c] / 8, 1);
    EXPECT_EQ(chooser.choose(0).cell, 1u);
    EXPECT_EQ(chooser.choose(std::nextafter(1.0, 0.0)).cell, 5u);
}

TEST(SampleNumbers, AreEvenAndUniformOverSeeds) {
    constexpr std::size_t n = 64, seeds = 2000;
    double sums[3] = {};
    for (std::size_t seed = 0; seed < seeds; ++seed) {
        for (std::size_t k = 0; k < n; ++k) {
            const SampleNumbers x = sampleNumbers(k, n, seed);
            EXPECT_EQ(static_cast<std::size_t>(x.along * n), k);
        }
        const SampleNumbers x = sampleNumbers(5, n, seed);
        sums[0] += x.along * n - 5, sums[1] += x.across, sums[2] += x.around;
    }
    // Five standard errors of the mean of 2,000 uniform numbers.
    for (const double sum : sums) EXPECT_NEAR(sum / seeds, 0.5, 5 * std::sqrt(1.0 / 12 / seeds));
}

// A statue of 12 mm under one light, small: with parts that shade others.
class TextureSpaceTest : public testing::Test {
protected:
    using Pixels = std::vector<Rgb>;

    TextureSpaceTest() : renderer_(shippedMaterials()) {
        scene_.object = "torus_knot";
        scene_.scale = 12;
        scene_.lights = {DirectionalLight{.direction = {1, 2, 1}}};
        settings_ = {.width = 24, .height = 16, .technique = "texture-space", .edge_samples = 1};
    }

    Pixels take(const ParamValues& options, std::uint64_t seed = 1) {
        settings_.technique_options = options;
        settings_.seed = seed;
        renderer_.setScene(scene_);
        renderer_.setSettings(settings_);
        Pixels pixels;
        for (const Rgba& p : renderer_.render(observer_).pixels) pixels.push_back({p.r, p.g, p.b});
        return pixels;
    }

    Pixels truth(std::size_t points = 150'000) {
        Renderer renderer(shippedMaterials());
        RenderSettings settings = settings_;
        settings.technique = "hierarchical";
        settings.points = points;
        settings.technique_options = {{"error", 1e-4}};
        settings.seed = 1;
        renderer.setScene(scene_);
        renderer.setSettings(settings);
        Pixels pixels;
        for (const Rgba& p : renderer.render(observer_).pixels) pixels.push_back({p.r, p.g, p.b});
        return pixels;
    }

    static double rmse(const Pixels& found, const Pixels& truth) {
        double errors = 0, squares = 0;
        for (std::size_t i = 0; i < truth.size(); ++i)
            for (int c = 0; c < Rgb::channels; ++c) {
                errors += std::pow(found[i][c] - truth[i][c], 2);
                squares += truth[i][c] * truth[i][c];
            }
        return std::sqrt(errors / squares);
    }

    /// Root of the mean squared error over seeds, and the error of the seeds' mean.
    std::pair<double, double> errors(const ParamValues& options, const Pixels& exact, int seeds) {
        Pixels mean(exact.size());
        double squares = 0;
        for (int seed = 1; seed <= seeds; ++seed) {
            const Pixels picture = take(options, static_cast<std::uint64_t>(seed));
            squares += std::pow(rmse(picture, exact), 2) / seeds;
            for (std::size_t i = 0; i < mean.size(); ++i) mean[i] = mean[i] + (1.0 / seeds) * picture[i];
        }
        return {std::sqrt(squares), rmse(mean, exact)};
    }

    Scene scene_;
    RenderSettings settings_;
    Renderer renderer_;
    Observer observer_;
};

TEST_F(TextureSpaceTest, IsUnbiasedWithLightOfItsOwn) {
    const Pixels exact = truth();
    constexpr int seeds = 96;
    std::vector<Pixels> pictures;
    for (int seed = 1; seed <= seeds; ++seed)
        pictures.push_back(
            take({{"samples", 400.0}, {"atlas", 64.0}, {"own_light", true}, {"footprint", 0.0}}, std::uint64_t(seed)));
    // The light of the whole picture by one number per seed, and that of its quarters.
    const auto sumOf = [&](const Pixels& pixels, int part) {
        double sum = 0;
        for (std::size_t i = 0; i < pixels.size(); ++i)
            if (part < 0 || static_cast<int>(4 * i / pixels.size()) == part) sum += luminance(pixels[i]);
        return sum;
    };
    for (int part = -1; part < 4; ++part) {
        double mean = 0, squares = 0;
        for (const Pixels& picture : pictures) mean += sumOf(picture, part) / seeds;
        for (const Pixels& picture : pictures) squares += std::pow(sumOf(picture, part) - mean, 2);
        const double error = std::sqrt(squares / (seeds - 1) / seeds), wanted = sumOf(exact, part);
        if (wanted < 1e-3 * sumOf(exact, -1)) continue;
        RecordProperty("relative_standard_error_" + std::to_string(part), std::to_string(error / wanted));
        // Five numbers, family-wise 1e-4; what the truth itself and R_d over a texel's disc may be off: 0.1 %.
        EXPECT_LT(std::abs(mean - wanted), 4.3 * error + 0.001 * wanted) << "part " << part;
    }
}

TEST_F(TextureSpaceTest, FallsFasterThanTheRootOfTheSamples) {
    const Pixels exact = truth();
    const double few = errors({{"samples", 100.0}}, exact, 6).first,
                 many = errors({{"samples", 1600.0}}, exact, 6).first;
    RecordProperty("at_100", std::to_string(few));
    RecordProperty("at_1600", std::to_string(many));
    EXPECT_LT(many, few / 4);  // 16 times the samples
    EXPECT_LT(many, 0.1);
}

// What the light at the middle of texels leaves when the samples are so many that they leave nothing.
TEST_F(TextureSpaceTest, ErrorOfTexelsFallsWithTheirSize) {
    const Pixels exact = truth();
    const auto at = [&](double side) { return errors({{"samples", 100000.0}, {"atlas", side}}, exact, 1).first; };
    const double coarse = at(64), fine = at(256);
    RecordProperty("at_64", std::to_string(coarse));
    RecordProperty("at_256", std::to_string(fine));
    EXPECT_LT(fine, 0.01);
    EXPECT_LT(fine, 0.6 * coarse);
}

TEST_F(TextureSpaceTest, TreesAndLoopAgree) {
    const Pixels tree = take({{"sum", std::string("tree")}}), loop = take({{"sum", std::string("loop")}});
    EXPECT_LT(rmse(tree, loop), 0.0015);  // what is asked of the trees, and the exit through the boundary on top
    EXPECT_GT(rmse(tree, take({}, 2)), 0.002);
}

TEST_F(TextureSpaceTest, TakesModelsThatReadDirections) {
    scene_.model.id = "directional_dipole";
    settings_.width = 12, settings_.height = 8;
    const Pixels exact = truth(30'000);
    const double few = errors({{"samples", 400.0}}, exact, 2).first,
                 many = errors({{"samples", 6400.0}}, exact, 2).first;
    RecordProperty("at_400", std::to_string(few));
    RecordProperty("at_6400", std::to_string(many));
    EXPECT_LT(many, few / 3);
    EXPECT_LT(many, 0.08);
}

TEST_F(TextureSpaceTest, IsBlackWithoutLight) {
    scene_.lights.clear();
    for (const Rgb& pixel : take({})) EXPECT_EQ(luminance(pixel), 0);
}

TEST_F(TextureSpaceTest, FollowsTheLightAndTheMaterial) {
    take({{"uvs", std::string("own")}});
    scene_.lights = {DirectionalLight{.direction = {-1, 1, 2}}};
    const Pixels moved = take({{"uvs", std::string("own")}});
    EXPECT_LT(rmse(moved, truth()), 0.15);
    scene_.material.id = "marble";
    const Pixels other = take({{"uvs", std::string("own")}});
    EXPECT_LT(rmse(other, truth()), 0.15);
    EXPECT_GT(rmse(other, moved), 0.2);
    const RenderReport& report = renderer_.report();
    EXPECT_GT(report.technique.numbers.at("charts"), 1);
    EXPECT_NEAR(report.technique.numbers.at("stretch_l2"), 1, 0.1);
}

}  // namespace
}  // namespace searchlight
