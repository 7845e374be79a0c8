#include "render/renderer.h"

#include <cmath>
#include <filesystem>
#include <numbers>

#include "base/error.h"
#include "io/image_file.h"
#include "model/physics.h"
#include "model/plane.h"
#include "scene/materials.h"

namespace searchlight {
namespace {

namespace fs = std::filesystem;

MaterialSource shippedMaterials() {
    return [](const Scene& scene) {
        RenderMaterial material{loadModel(scene.model.id), resolveMaterial(scene.material).medium, nullptr};
        material.evaluator = makeNativeEvaluator(material.model);
        material.evaluator->set(material.medium, {});
        return material;
    };
}

RenderSettings small(std::string technique = "hierarchical") {
    return {.width = 48, .height = 32, .points = 4000, .technique = std::move(technique), .light_samples = 64};
}

Scene sphereScene() {
    Scene scene;
    scene.scale = 20;
    return scene;
}

class RendererTest : public testing::Test {
protected:
    void SetUp() override {
        std::string name = (fs::temp_directory_path() / "searchlight-XXXXXX").string();
        ASSERT_NE(mkdtemp(name.data()), nullptr);
        folder_ = name;
    }
    void TearDown() override { fs::remove_all(folder_); }

    /// Surroundings of that radiance everywhere.
    EnvironmentLight uniform(float radiance) const {
        const std::string path = (folder_ / "uniform.pfm").string();
        writeImage(path, {Image(16, 8, {radiance, radiance, radiance, 1})});
        return {.path = path};
    }

    Observer observer_;
    fs::path folder_;
};

// As a radial model that has the same profile, and the report says so.
TEST_F(RendererTest, TakesAModelThatReadsDirectionsUnderANormalBeamWhereAsked) {
    Scene scene = sphereScene();
    scene.model.id = "better_dipole+single";
    Renderer renderer(shippedMaterials());
    renderer.setScene(scene);
    RenderSettings settings = small();
    renderer.setSettings(settings);
    const Image directional = renderer.render(observer_);
    EXPECT_TRUE(renderer.report().notes.empty());
    settings.technique_options = {{"normal_beam", true}};
    renderer.setSettings(settings);
    const Image radial = renderer.render(observer_);
    ASSERT_FALSE(renderer.report().notes.empty());
    EXPECT_EQ(renderer.report().notes.front(), "At every angle the model stands with its profile under a normal beam.");
    EXPECT_NE(directional.pixels, radial.pixels);
    settings.technique = "brute_force";
    renderer.setSettings(settings);
    const Image exact = renderer.render(observer_);
    double error = 0, sum = 0;
    for (std::size_t i = 0; i < exact.pixels.size(); ++i) {
        error += std::pow(exact.pixels[i].g - radial.pixels[i].g, 2);
        sum += std::pow(exact.pixels[i].g, 2);
    }
    EXPECT_LT(std::sqrt(error / sum), 0.005);  // the default of the option "error"
}

TEST_F(RendererTest, UniformLightOnASphereGivesItsProfilesIntegral) {
    // On a sphere the area within the chord r is pi r^2, as on the plane, so the sum over the surface is the integral
    // of the profile up to the diameter. Half a unit of radiance all around: E = pi/2, of which the hemispherical mean
    // of T12 enters.
    Scene scene = sphereScene();
    scene.lights = {uniform(0.5f)};
    scene.camera.azimuth_deg = scene.camera.elevation_deg = 0;
    const RenderMaterial material = shippedMaterials()(scene);
    const Profile profile = tabulate(*material.evaluator, material.model, material.medium).profile;
    const double eta = material.medium.eta;
    // The hemispherical mean of T12, and with 1/pi the normaliser of T21, are the same integral.
    const double diffuse = 1 - 2 * Physics<double>::fresnelMoment(1, 1 / eta);
    const Rgb exitance = 0.5 * std::numbers::pi * diffuse * profile.encircled(20);
    // In the middle of the picture the sphere is seen along its normal.
    const Rgb expected =
        (1 - Physics<double>::fresnelReflectance(1, 1 / eta)) / (std::numbers::pi * diffuse) * exitance;
    for (const char* technique : {"hierarchical", "brute_force"}) {
        Renderer renderer(shippedMaterials());
        renderer.setScene(scene);
        renderer.setSettings(small(technique));
        const Rgba middle = renderer.render(observer_).at(24, 16);
        // 0.5 % that the sum may miss, as much for 64 directions and for the spacing of 4,000 points.
        EXPECT_NEAR(middle.r / expected.r, 1, 0.02) << technique;
        EXPECT_NEAR(middle.g / expected.g, 1, 0.02) << technique;
        EXPECT_NEAR(middle.b / expected.b, 1, 0.02) << technique;
        EXPECT_EQ(middle.a, 1);
    }
}

TEST_F(RendererTest, RedoesOnlyWhatAChangeMakesStale) {
    Renderer renderer(shippedMaterials());
    Scene scene = sphereScene();
    RenderSettings settings = small();
    const auto runsAfter = [&](const auto& change) {
        const RenderReport before = renderer.report();
        change();
        renderer.setScene(scene);
        renderer.setSettings(settings);
        renderer.render(observer_);
        std::string ran;
        for (std::size_t i = 0; i < stage_count; ++i)
            if (renderer.report().stages[i].runs > before.stages[i].runs)
                ran += std::string(stageName(static_cast<Stage>(i))) + " ";
        return ran;
    };
    EXPECT_EQ(runsAfter([] {}), "object rays material points visible irradiance exitance background coat shade ");
    EXPECT_EQ(runsAfter([] {}), "");
    EXPECT_EQ(runsAfter([&] { scene.material.scale = 2; }), "material exitance shade ");
    EXPECT_EQ(runsAfter([&] { scene.model.id = "better_dipole"; }), "material exitance shade ");
    EXPECT_EQ(runsAfter([&] { scene.camera.azimuth_deg = 80; }), "visible exitance background shade ");
    EXPECT_EQ(runsAfter([&] { settings.preview = 0.5; }), "visible exitance background shade ");
    EXPECT_EQ(runsAfter([&] { settings.technique_options["error"] = 0.01; }), "exitance shade ");
    EXPECT_EQ(runsAfter([&] { scene.backdrop = Rgb{1, 1, 1}; }), "background shade ");
    EXPECT_EQ(runsAfter([&] { scene.lights = {PointLight{}}; }), "irradiance exitance background shade ");
    EXPECT_EQ(runsAfter([&] { settings.points = 3000; }), "points irradiance exitance shade ");
    EXPECT_EQ(runsAfter([&] { scene.material.id = "whole_milk"; }), "material exitance shade ");  // of the same eta
    EXPECT_EQ(runsAfter([&] { scene.material.id = "marble"; }), "material irradiance exitance shade ");
    EXPECT_EQ(runsAfter([&] { scene.scale = 21; }), "object rays points visible irradiance exitance background shade ");
}

TEST_F(RendererTest, WhatIsKeptGivesThePictureOfAFreshStart) {
    Scene scene = sphereScene();
    Renderer kept(shippedMaterials()), fresh(shippedMaterials());
    kept.setScene(scene);
    kept.setSettings(small());
    kept.render(observer_);
    scene.material.id = "marble";
    scene.camera.elevation_deg = -20;
    for (Renderer* renderer : {&kept, &fresh}) {
        renderer->setScene(scene);
        renderer->setSettings(small());
    }
    const Image a = kept.render(observer_), b = fresh.render(observer_);
    ASSERT_EQ(a.pixels.size(), b.pixels.size());
    double difference = 0, sum = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        difference = std::max<double>(difference, std::abs(a.pixels[i].g - b.pixels[i].g));
        sum = std::max<double>(sum, b.pixels[i].g);
    }
    // The same sum up to what the calibration that was kept may change within the error asked for.
    EXPECT_LT(difference, 0.02 * sum);
}

TEST_F(RendererTest, TheHierarchyKeepsTheErrorThatWasAskedForInEveryLight) {
    const std::vector<std::vector<Light>> modes{
        {DirectionalLight{}}, {PointLight{.position = {0.2, 0.9, 0.4}}}, {uniform(1), DirectionalLight{{-1, 0, 0}}}};
    for (const auto& lights : modes)
        for (const char* object : {"sphere", "torus_knot"}) {
            Scene scene = sphereScene();
            scene.object = object;
            scene.lights = lights;
            Renderer fast(shippedMaterials()), exact(shippedMaterials());
            RenderSettings settings = small();
            settings.technique_options["error"] = 0.002;
            fast.setScene(scene);
            fast.setSettings(settings);
            exact.setScene(scene);
            exact.setSettings(small("brute_force"));
            const Image a = fast.render(observer_), b = exact.render(observer_);
            Rgb error, total;
            for (std::size_t i = 0; i < a.pixels.size(); ++i) {
                const Rgb x{a.pixels[i].r, a.pixels[i].g, a.pixels[i].b},
                    y{b.pixels[i].r, b.pixels[i].g, b.pixels[i].b};
                error = error + (x - y) * (x - y);
                total = total + y * y;
            }
            for (int c = 0; c < 3; ++c) EXPECT_LT(std::sqrt(error[c] / total[c]), 0.002) << object << c;
            EXPECT_LE(fast.report().technique.error_bound, 0.002);
            EXPECT_EQ(exact.report().technique.interactions, exact.report().points * exact.report().receivers);
        }
}

TEST_F(RendererTest, AModelThatReadsDirectionsIsSummedByBothTechniques) {
    // Far from its edges and under normal light the directional dipole of a large flat object gives its total.
    Scene scene = sphereScene();
    scene.model.id = "directional_dipole";
    scene.scale = 60;
    scene.camera.azimuth_deg = scene.camera.elevation_deg = 0;
    scene.lights = {DirectionalLight{.direction = {0, 0, 1}}};
    Renderer renderer(shippedMaterials());
    renderer.setScene(scene);
    RenderSettings settings{.width = 3, .height = 3, .points = 20000, .technique = "brute_force", .edge_samples = 1};
    renderer.setSettings(settings);
    const Image image = renderer.render(observer_);
    EXPECT_GT(renderer.report().technique.interactions, 0u);
    for (const Rgba& pixel : image.pixels) {
        if (pixel.a == 0) continue;
        EXPECT_TRUE(std::isfinite(pixel.r) && pixel.r > 0);
    }
    // Half the sphere is dark, and the first picture shows what is known.
    EXPECT_GT(image.at(1, 1).r, image.at(0, 1).r);

    settings.technique = "hierarchical";
    renderer.setSettings(settings);
    const Image grouped = renderer.render(observer_);
    // The error that is asked for without an option.
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        EXPECT_NEAR(grouped.pixels[i].g, image.pixels[i].g, 0.02 * image.at(1, 1).g);
    EXPECT_LE(renderer.report().technique.error_bound, 0.005);
}

TEST_F(RendererTest, BruteForceShowsAPictureBeforeItIsDone) {
    struct Counting : Observer {
        void progress(std::string_view task, std::uint64_t done, std::uint64_t total, std::string_view) override {
            if (task != "brute force") return;
            EXPECT_GT(done, last);
            EXPECT_LE(done, total);
            last = done;
        }
        std::uint64_t last = 0;
    } observer;
    Scene scene = sphereScene();
    scene.model.id = "directional_dipole";
    Renderer renderer(shippedMaterials());
    renderer.setScene(scene);
    renderer.setSettings({.width = 120, .height = 80, .points = 40000, .technique = "brute_force", .edge_samples = 1});
    renderer.start(observer);
    ASSERT_FALSE(renderer.step(observer));
    EXPECT_GT(observer.last, 0u);
    EXPECT_LT(observer.last, renderer.report().receivers);
    const Image& first = renderer.image(observer);
    EXPECT_GT(first.at(60, 40).r, 0);
    EXPECT_GT(first.at(61, 43).r, 0);
}

TEST_F(RendererTest, TheGroundIsLitAndShadowed) {
    Scene scene = sphereScene();
    scene.ground.emplace();
    scene.camera = {.azimuth_deg = 0, .elevation_deg = 12, .distance = 4};
    scene.lights = {DirectionalLight{.direction = {0, 1, 0}, .irradiance = {2, 2, 2}}};
    Renderer renderer(shippedMaterials());
    renderer.setScene(scene);
    renderer.setSettings({.width = 96, .height = 64, .points = 2000});
    const Image image = renderer.render(observer_);
    // Diffuse: albedo / pi times irradiance.
    const Rgba lit = image.at(5, 60);
    EXPECT_NEAR(lit.r, 0.5 / std::numbers::pi * 2, 1e-5);
    EXPECT_EQ(lit.a, 1);
    // Straight below the sphere lies its shadow: seen just under its silhouette.
    int shadowed = 0;
    for (const Rgba& pixel : image.pixels) shadowed += pixel.a == 1 && pixel.r == 0;
    EXPECT_GT(shadowed, 20);
    // Above the horizon there is nothing.
    EXPECT_EQ(image.at(5, 2).a, 0);
}

TEST_F(RendererTest, TheSurroundingsAreSeenBehindTheObject) {
    Scene scene = sphereScene();
    scene.lights = {uniform(0.25f)};
    Renderer renderer(shippedMaterials());
    renderer.setScene(scene);
    renderer.setSettings(small());
    EXPECT_EQ(renderer.render(observer_).at(0, 0), (Rgba{0.25f, 0.25f, 0.25f, 1}));
    scene.backdrop = Rgb{1, 2, 3};
    renderer.setScene(scene);
    EXPECT_EQ(renderer.render(observer_).at(0, 0), (Rgba{1, 2, 3, 1}));
}

TEST_F(RendererTest, PreviewHalvesThePicture) {
    Renderer renderer(shippedMaterials());
    renderer.setScene(sphereScene());
    RenderSettings settings = small();
    settings.preview = 0.5;
    renderer.setSettings(settings);
    const Image image = renderer.render(observer_);
    EXPECT_EQ(image.width, 24);
    EXPECT_EQ(image.height, 16);
}

TEST(DefaultPointCount, FollowsAreaAndMeanFreePath) {
    Medium medium{.sigma_a = {0, 0, 0}, .sigma_s = {1, 2, 4}, .eta = 1.3};
    // 0.25 mm apart: 16 points per mm^2.
    EXPECT_EQ(defaultPointCount(1000, medium), 100'000u);
    EXPECT_EQ(defaultPointCount(20000, medium), 400'000u);
    EXPECT_EQ(defaultPointCount(1e9, medium), 800'000u);
    EXPECT_FALSE(noteOfFewPoints(50000, medium));  // wants just those
    const std::optional<std::string> note = noteOfFewPoints(100'000, medium);
    ASSERT_TRUE(note);
    EXPECT_NE(note->find("800000 points"), std::string::npos) << *note;
    EXPECT_NE(note->find("1.6 million"), std::string::npos) << *note;
}

}  // namespace
}  // namespace searchlight
