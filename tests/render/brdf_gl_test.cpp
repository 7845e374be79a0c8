#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <numbers>

#include "base/error.h"
#include "base/files.h"
#include "gl/context.h"
#include "io/image_file.h"
#include "render/brdf_evaluator.h"
#include "render/coat.h"

namespace searchlight {
namespace {

constexpr double pi = std::numbers::pi;

std::string lambert() {
    return "analytic\n"
           "# diffuse\n"
           "::begin parameters\n"
           "color albedo 0.2 0.5 0.8\n"
           "bool invert 0\n"
           "::end parameters\n"
           "::begin shader\n"
           "const float PI = 3.14159265358979323846;\n"
           "float G(float x) { return x / PI; }\n"
           "vec3 BRDF(vec3 L, vec3 V, vec3 N, vec3 X, vec3 Y) {\n"
           "    if (invert) return vec3(0.0);\n"
           "    return albedo * G(1.0);\n"
           "}\n"
           "::end shader\n";
}

std::string message(const std::string& text, gl::Context& context) {
    try {
        BrdfEvaluator evaluator(parseBrdf(text, "a.brdf"), {}, context);
        const BrdfQuery query{{0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}};
        Rgb value;
        evaluator.evaluate({&query, 1}, {&value, 1});
    } catch (const Error& error) {
        return error.what();
    }
    return "no error";
}

TEST(Brdf, GivesEveryVectorToTheShader) {
    gl::Context context;
    const std::string text =
        "analytic\n::begin shader\nvec3 BRDF(vec3 L, vec3 V, vec3 N, vec3 X, vec3 Y) {\n"
        "  return vec3(dot(L, V), dot(N, X) + 2.0 * dot(N, Y), L.x + V.y);\n}\n::end shader\n";
    BrdfEvaluator evaluator(parseBrdf(text, "a.brdf"), {}, context);
    const BrdfQuery query{{0.5, 0, 0}, {0.25, 3, 0}, {1, 2, 3}, {1, 0, 0}, {0, 1, 0}};
    Rgb value;
    evaluator.evaluate({&query, 1}, {&value, 1});
    EXPECT_EQ(value, (Rgb{0.125, 5, 3.5}));
}

// PI and G are names that models have; the file's own ones win.
TEST(Brdf, LambertIsItsClosedForm) {
    gl::Context context;
    const std::filesystem::path folder = std::filesystem::path(SEARCHLIGHT_BINARY_DIR) / "tests/brdf";
    std::filesystem::create_directories(folder);
    writeFile(folder / "lambert.brdf", lambert());
    Scene scene;
    scene.coat = Coat{0, (folder / "lambert.brdf").string(), {}};
    DirectionalLight sun;
    sun.direction = {1, 2, 2};
    sun.irradiance = {3, 3, 3};
    scene.lights = {sun};
    Object object;
    object.longest_mm = 10;
    Observer observer;
    // More samples than go into one batch, all alike.
    const std::vector<Vec3f> positions(2500), up(2500, {0, 0, 1}), wo(2500, {0.6f, 0, 0.8f});
    CoatOptions options;
    options.context = &context;
    const auto radiance = [&] {
        return coatRadiance({positions, up, up, wo}, scene, object, nullptr, options, observer);
    };
    for (const Rgbf& value : radiance()) {
        // albedo / pi E cos, in single precision
        ASSERT_NEAR(value.r, 0.2 / pi * 3 * 2 / 3, 1e-6);
        ASSERT_NEAR(value.b, 0.8 / pi * 3 * 2 / 3, 1e-6);
    }
    scene.coat->parameters = {{"albedo", std::vector<double>{0.4, 0.1, 0.2}}};
    for (const Rgbf& value : radiance()) ASSERT_NEAR(value.r, 0.4 / pi * 3 * 2 / 3, 1e-6);
    scene.coat->parameters = {{"invert", true}};
    for (const Rgbf& value : radiance()) ASSERT_EQ(value, Rgbf{});
    scene.coat->parameters.clear();
    // Under an even sky of radiance 1 the whole albedo comes back.
    writeImage((folder / "even.pfm").string(), {Image(64, 32, {1, 1, 1, 1}), {}, {}});
    EnvironmentLight sky;
    sky.path = (folder / "even.pfm").string();
    scene.lights = {sky};
    options.picture_samples = 128;
    double mean = 0;
    for (const Rgbf& value : radiance()) mean += value.g / 2500;
    EXPECT_NEAR(mean, 0.5, 0.5e-3);
}

TEST(Brdf, ErrorsHaveTheirPlaceInTheFile) {
    gl::Context context;
    std::string text = lambert();
    text.replace(text.find("G(1.0)"), 6, "H(1.0)");
    EXPECT_TRUE(message(text, context).starts_with("a.brdf:12:21: ")) << message(text, context);
    text = lambert();
    text.replace(text.find("    return albedo"), 4, "for (int i = 0; i >= 0; ) albedo;");
    const std::string endless = message(text, context);
    EXPECT_TRUE(endless.starts_with("a.brdf:12: loop at line 12 exceeded")) << endless;
}

}  // namespace
}  // namespace searchlight
