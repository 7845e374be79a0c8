#include "render/coat.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <numbers>

#include "base/error.h"
#include "io/image_file.h"
#include "render/ggx.h"

namespace searchlight {
namespace {

constexpr double pi = std::numbers::pi;

// One point on the plane z = 0, seen at an angle; lengths in mm, the object is 10 mm long.
class CoatTest : public ::testing::Test {
protected:
    CoatTest() {
        object_.longest_mm = 10;
        object_.half_extent = {5, 5, 5};
        scene_.coat = Coat{0.5, ""};
        scene_.lights.clear();
    }

    Rgb radiance(const RayScene* rays = nullptr) {
        const Vec3f position{0, 0, 0}, up{0, 0, 1}, wo = toFloat(wo_);
        const std::vector<Rgbf> values =
            coatRadiance({{&position, 1}, {&up, 1}, {&up, 1}, {&wo, 1}}, scene_, object_, rays, options_, observer_);
        return toDouble(values.at(0));
    }

    Ggx ggx() const { return {scene_.coat->roughness * scene_.coat->roughness, options_.eta, false}; }

    // A latitude-longitude picture as a light; `shade` gives R by the pixel's height from 0 (top) to 1.
    static EnvironmentLight environment(const std::string& name, float (*shade)(float)) {
        Image picture(256, 128);
        for (int y = 0; y < 128; ++y)
            for (int x = 0; x < 256; ++x) picture.at(x, y) = {shade((static_cast<float>(y) + 0.5f) / 128), 1, 0.5f, 1};
        const std::filesystem::path folder = std::filesystem::path(SEARCHLIGHT_BINARY_DIR) / "tests/coat";
        std::filesystem::create_directories(folder);
        EnvironmentLight light;
        light.path = (folder / (name + ".pfm")).string();
        writeImage(light.path, {picture, {}, {}});
        return light;
    }

    Scene scene_;
    Object object_;
    CoatOptions options_;
    Observer observer_;
    Vec3 wo_ = normalize({0.3, -0.2, 0.8});
};

TEST_F(CoatTest, OfParallelLightIsTheBrdf) {
    DirectionalLight light;
    light.direction = {-1, 1, 2};
    light.irradiance = {1, 2, 3};
    scene_.lights = {light};
    const Vec3 wi = normalize(light.direction);
    const double value = ggxValue(ggx(), wi, wo_) * wi.z;
    // The sample's directions are single precision.
    EXPECT_NEAR(radiance().r, value, 1e-5 * value);
    EXPECT_NEAR(radiance().b, 3 * value, 3e-5 * value);
}

TEST_F(CoatTest, OfAPointFallsWithTheSquare) {
    PointLight light;
    light.position = {-1, 1, 2};  // 24.5 mm away
    light.intensity = {6, 6, 6};  // over the squared distance: 1
    scene_.lights = {light};
    const Vec3 wi = normalize(light.position);
    const double value = ggxValue(ggx(), wi, wo_) * wi.z;
    EXPECT_NEAR(radiance().r, value, 1e-5 * value);
    scene_.lights = {PointLight{{-2, 2, 4}, {6, 6, 6}}};
    EXPECT_NEAR(radiance().r, value / 4, 1e-5 * value);
}

// The sun's disc is so small beside the facets' spread that it acts like its centre: to the order of (0.0046 / 0.25)^2.
TEST_F(CoatTest, OfTheSunIsThatOfItsCentre) {
    DirectionalLight light;
    light.direction = {-1, 1, 2};
    scene_.lights = {light};
    const double parallel = radiance().r;
    light.angle_deg = 0.53;
    scene_.lights = {light};
    EXPECT_NEAR(radiance().r, parallel, 1e-3 * parallel);
}

TEST_F(CoatTest, WithoutRoughnessIsAMirror) {
    scene_.coat->roughness = 0;
    scene_.lights = {environment("ramp", [](float height) { return height; })};
    const double fresnel = ggxFresnel(ggx(), wo_.z);
    // The reflected direction is (-x, -y, z) of wo; y is up in the picture.
    const double height = std::acos(-wo_.y) / pi;
    EXPECT_NEAR(radiance().r, fresnel * height, 1e-5);
    EXPECT_NEAR(radiance().g, fresnel, 1e-6);
    // A mirror sees the sun where it stands, with its radiance, and not beside it.
    DirectionalLight sun;
    sun.direction = {-wo_.x, -wo_.y, wo_.z};
    sun.angle_deg = 2;
    scene_.lights = {sun};
    const double sine = std::sin(pi / 180);
    EXPECT_NEAR(radiance().r, fresnel / (pi * sine * sine), 1e-4 * fresnel / (pi * sine * sine));
    sun.direction = wo_;
    scene_.lights = {sun};
    EXPECT_EQ(radiance().r, 0);
}

// Both ways of choosing directions together are unbiased for a narrow lobe (the reflection's choice counts) and a wide
// one, before an even and an uneven picture. 3 %: the error of 4096 stratified samples is well below.
TEST_F(CoatTest, OfAnEnvironmentIsItsIntegral) {
    options_.picture_samples = 4096;
    scene_.lights = {environment("steep", [](float height) { return std::fmax(0.f, 1 - 4 * height); })};
    for (const double roughness : {0.15, 0.4, 0.9}) {
        scene_.coat->roughness = roughness;
        const Ggx facets = ggx();
        Rgb expected;
        constexpr int steps = 500;
        for (int i = 0; i < steps; ++i)
            for (int k = 0; k < 2 * steps; ++k) {
                const double cosine = (i + 0.5) / steps, azimuth = pi * (k + 0.5) / steps;
                const double sine = std::sqrt(1 - cosine * cosine);
                const Vec3 wi{sine * std::cos(azimuth), sine * std::sin(azimuth), cosine};
                const double weight = ggxValue(facets, wi, wo_) * cosine * pi / (static_cast<double>(steps) * steps);
                expected = expected + weight * Rgb{std::fmax(0, 1 - 4 * std::acos(wi.y) / pi), 1, 0.5};
            }
        const Rgb found = radiance();
        EXPECT_NEAR(found.r, expected.r, 0.03 * expected.r) << roughness;
        EXPECT_NEAR(found.g, expected.g, 0.01 * expected.g) << roughness;
    }
}

TEST_F(CoatTest, IsDarkInShadow) {
    Mesh roof;
    roof.positions = {{-50, -50, 3}, {50, -50, 3}, {0, 80, 3}};
    roof.triangles = {{0, 1, 2}};
    const RayScene rays(roof);
    EnvironmentLight lit = environment("even", [](float) { return 1.f; });
    lit.occlusion = true;
    DirectionalLight sun;
    sun.direction = {0, 0.1, 1};
    sun.angle_deg = 0.5;
    scene_.lights = {sun, PointLight{{0, 0, 1}, {1, 1, 1}}};
    EXPECT_GT(radiance().r, 0);
    EXPECT_EQ(radiance(&rays).r, 0);
    scene_.lights = {PointLight{{0, 0, 0.2}, {1, 1, 1}}};  // below the roof
    EXPECT_GT(radiance(&rays).r, 0);
    scene_.lights = {lit};
    const double open = radiance().g, occluded = radiance(&rays).g;
    EXPECT_LT(occluded, 0.1 * open);
}

TEST_F(CoatTest, NeedsOpenGlForAFileAndTheFile) {
    scene_.coat->brdf = "nowhere.brdf";
    try {
        radiance();
        FAIL();
    } catch (const Error& error) {
        EXPECT_STREQ(error.what(), "nowhere.brdf: no such file");
    }
}

}  // namespace
}  // namespace searchlight
