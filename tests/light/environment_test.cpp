#include "light/environment.h"

#include <filesystem>
#include <numbers>

#include "base/error.h"
#include "light/environment_irradiance.h"
#include "light/places.h"
#include "light/stratified.h"
#include "light/transmitted_cosine.h"

namespace searchlight {
namespace {

using test::brightPixel;

constexpr double pi = std::numbers::pi;

Environment environment(Image picture, const EnvironmentLight& light = {}) {
    return Environment(std::move(picture), light, "sky.hdr");
}

// The direction in which the environment is brightest, of many on the sphere.
Vec3 brightest(const Environment& sky) {
    Vec3 best;
    double most = -1;
    for (int i = 0; i < 60000; ++i) {
        const double y = 1 - (i + 0.5) / 30000, phi = i * 2.399963229728653;  // the golden angle
        const Vec3 wi{std::sqrt(1 - y * y) * std::sin(phi), y, std::sqrt(1 - y * y) * std::cos(phi)};
        const double value = luminance(sky.radiance(wi));
        if (value > most) most = value, best = wi;
    }
    return best;
}

// Degrees between two directions.
double apart(Vec3 a, Vec3 b) { return std::acos(std::clamp(dot(normalize(a), normalize(b)), -1.0, 1.0)) * 180 / pi; }

TEST(Environment, CentreIsSeenAlongMinusZAndTheRightHalfShowsPlusX) {
    // 64 x 32 pixels of 5.6 degrees; the golden spiral is finer than one.
    EXPECT_LT(apart(brightest(environment(brightPixel(64, 32, 32, 16))), {0.05, -0.05, -1}), 3);
    EXPECT_LT(apart(brightest(environment(brightPixel(64, 32, 48, 16))), {1, -0.05, 0.05}), 3);
    EXPECT_LT(apart(brightest(environment(brightPixel(64, 32, 16, 16))), {-1, -0.05, -0.05}), 3);
    EXPECT_LT(apart(brightest(environment(brightPixel(64, 32, 0, 16))), {-0.05, -0.05, 1}), 3);
    EXPECT_LT(apart(brightest(environment(brightPixel(64, 32, 32, 8))), {0, 1, -1}), 5);
    // A top row of one pixel in a colour of its own is what lies above.
    Image picture(64, 32, {0, 0, 0, 1});
    for (int x = 0; x < 64; ++x) picture.at(x, 0) = {1, 1, 1, 1};
    EXPECT_NEAR(environment(picture).radiance({0, 1, 0}).r, 1, 1e-6);
}

TEST(Environment, RotationTurnsTheSurroundingsFromPlusZTowardsPlusX) {
    const Image behind = brightPixel(64, 32, 32, 16);  // at -z
    EXPECT_LT(apart(brightest(environment(behind, {.rotation_deg = 90})), {-1, -0.05, -0.05}), 3);
    const Environment turned = environment(behind, {.rotation_deg = 37});
    const EnvironmentSample sample = turned.sample(0.5, 0.5);
    EXPECT_GT(sample.radiance.r, 0);
    EXPECT_LT(apart(sample.wi, brightest(turned)), 6);
}

TEST(Environment, RoundPicturesShowTheSameDirections) {
    // A mirror ball's middle reflects the photographer at +z; halfway to the rim (sin 45 degrees) the side.
    const int n = 200, side = 100 + static_cast<int>(100 * std::sqrt(0.5));
    const EnvironmentLight ball{.layout = "mirror_ball"};
    EXPECT_LT(apart(brightest(environment(brightPixel(n, n, 100, 100), ball)), {0, 0, 1}), 2);
    EXPECT_LT(apart(brightest(environment(brightPixel(n, n, side, 100), ball)), {1, 0, 0}), 2);
    EXPECT_LT(apart(brightest(environment(brightPixel(n, n, 100, 199 - side), ball)), {0, 1, 0}), 2);
    // An angular map's middle is straight ahead; halfway to the rim is 90 degrees.
    const EnvironmentLight map{.layout = "angular"};
    EXPECT_LT(apart(brightest(environment(brightPixel(n, n, 100, 100), map)), {0, 0, -1}), 2);
    EXPECT_LT(apart(brightest(environment(brightPixel(n, n, 150, 100), map)), {1, 0, 0}), 2);
    EXPECT_LT(apart(brightest(environment(brightPixel(n, n, 100, 49), map)), {0, 1, 0}), 2);
}

TEST(Environment, UniformPictureHasFourPiOfRadianceAndAUniformDensity) {
    const Environment sky = environment(Image(32, 16, {2, 2, 2, 1}), {.intensity = {1, 0.5, 0}});
    EXPECT_NEAR(sky.totalRadiance().r, 8 * pi, 1e-9);
    EXPECT_NEAR(sky.totalRadiance().g, 4 * pi, 1e-9);
    EXPECT_EQ(sky.totalRadiance().b, 0);
    for (const Vec3 wi : {Vec3{0, 1, 0}, Vec3{1, 0.2, -3}, Vec3{0, -1, 0}})
        EXPECT_NEAR(sky.pdf(wi), 1 / (4 * pi), 1e-9);
}

TEST(Environment, SamplesEstimateTheTotalWithoutBiasAndReportTheirDensity) {
    // A picture with black rows, one strong pixel and a coloured gradient.
    Image picture(16, 8, {0, 0, 0, 1});
    for (int x = 0; x < 16; ++x) picture.at(x, 2) = {0.1f * static_cast<float>(x), 0.3f, 0.2f, 1};
    picture.at(3, 5) = {50, 40, 10, 1};
    const Environment sky = environment(picture, {.rotation_deg = 20});
    const StratifiedSequence sequence(5);
    Rgb mean, squares;
    constexpr int n = 1 << 16;
    for (int i = 0; i < n; ++i) {
        const auto [u, v] = sequence(static_cast<std::uint32_t>(i));
        const EnvironmentSample s = sky.sample(u, v);
        ASSERT_NEAR(s.pdf, sky.pdf(s.wi), 1e-6 * s.pdf);  // rounding puts none across a cell's border here
        const Rgb at = sky.radiance(s.wi);
        ASSERT_NEAR(s.radiance.g, at.g, 1e-9 + 1e-6 * at.g);
        mean = mean + (1.0 / n / s.pdf) * s.radiance;
        squares = squares + (1.0 / n / s.pdf / s.pdf) * (s.radiance * s.radiance);
    }
    // The integral of the bilinear picture by brute force; cells of 1/40 pixel.
    Rgb truth;
    for (int j = 0; j < 320; ++j)
        for (int i = 0; i < 640; ++i) {
            const double theta = pi * (j + 0.5) / 320, phi = 2 * pi * (i + 0.5) / 640;
            const double area = std::sin(theta) * pi / 320 * 2 * pi / 640;
            truth = truth + area * sky.radiance({std::sin(theta) * std::sin(phi), std::cos(theta),
                                                 std::sin(theta) * std::cos(phi)});
        }
    for (int c = 0; c < 3; ++c) {
        // Four standard errors of independent samples; stratified ones have less. 1e-4: the brute force.
        const double error = std::sqrt((squares[c] - mean[c] * mean[c]) / n);
        EXPECT_NEAR(mean[c], truth[c], 4 * error + 1e-4 * truth[c]);
        EXPECT_NEAR(sky.totalRadiance()[c], truth[c], 0.02 * truth[c]);  // one weight per cell, and rows of 22 degrees
    }
}

TEST(Environment, KnownPicturesIntegrateToTheirKnownValues) {
    // Sums over pixels of radiance times solid angle, computed when the files were collected.
    const std::string folder = SEARCHLIGHT_SOURCE_DIR "/../shared/data/envmaps/";
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not here";
    const std::pair<const char*, Rgb> known[] = {{"venice_sunset_1k.hdr", {6.421, 6.061, 7.704}},
                                                 {"grace_latlong.exr", {0.281, 0.156, 0.193}},
                                                 {"museum.exr", {6.427, 5.233, 4.634}},
                                                 {"blender_courtyard.exr", {11.57, 9.11, 9.04}}};
    for (const auto& [name, total] : known) {
        const Rgb got = Environment(EnvironmentLight{.path = folder + name}).totalRadiance();
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(got[c] / total[c], 1, 0.003) << name;  // three or four digits
    }
}

TEST(Environment, BlackPictureIsNoLight) {
    const Environment black = environment(Image(8, 4, {0, 0, 0, 1}));
    EXPECT_EQ(black.sample(0.3, 0.7).pdf, 0);
    EXPECT_EQ(black.pdf({0, 1, 0}), 0);
    EXPECT_EQ(black.totalRadiance(), Rgb{});
}

std::string messageFor(Image picture, const std::string& layout = "latlong") {
    try {
        environment(std::move(picture), {.layout = layout});
    } catch (const Error& error) {
        EXPECT_EQ(error.kind, ErrorKind::input);
        return error.what();
    }
    return "no error";
}

TEST(Environment, BadPicturesAreOneClearError) {
    EXPECT_EQ(messageFor(Image(100, 100, {1, 1, 1, 1})),
              "sky.hdr: 100 x 100 pixels are no latitude-longitude picture (expected twice as wide as high)");
    EXPECT_EQ(messageFor(Image(200, 100, {1, 1, 1, 1}), "mirror_ball"),
              "sky.hdr: 200 x 100 pixels are no picture of a ball (expected a square)");
    EXPECT_EQ(messageFor(brightPixel(4, 2, 3, 1, {1, INFINITY, 1, 1})),
              "sky.hdr: pixel 3, 1 is infinite or not a number: no light (counted from the top left, from 0)");
    EXPECT_EQ(messageFor(brightPixel(4, 2, 0, 1, {NAN, 1, 1, 1})),
              "sky.hdr: pixel 0, 1 is infinite or not a number: no light (counted from the top left, from 0)");
    EXPECT_EQ(messageFor(Image()), "sky.hdr: a picture without pixels");
    // Filters leave slightly negative values in real files.
    EXPECT_EQ(environment(Image(4, 2, {-0.01f, 1, 1, 1})).totalRadiance().r, 0);
}

// The largest error of the table of harmonics over all normals, relative to the largest value, for light from one
// pixel.
double onePixelError(double eta) {
    // 1024 x 512: a pixel of 0.35 degrees, off the rows and columns of the table.
    const Environment sky = environment(brightPixel(1024, 512, 301, 200, {1e4f, 1e4f, 1e4f, 1}));
    const EnvironmentIrradiance table(sky, eta);
    const double phi = 2 * pi * (301.5 / 1024 - 0.5), theta = pi * 200.5 / 512;
    const Vec3 sun{std::sin(theta) * std::sin(phi), std::cos(theta), -std::sin(theta) * std::cos(phi)};
    const double irradiance = sky.totalRadiance().r;
    double largest = 0;
    for (int i = 0; i < 20000; ++i) {
        const double y = 1 - (i + 0.5) / 10000, turn = i * 2.399963229728653;
        const Vec3 n{std::sqrt(1 - y * y) * std::sin(turn), y, std::sqrt(1 - y * y) * std::cos(turn)};
        largest = std::max(largest, std::abs(table(toFloat(n)).r - irradiance * transmittedCosine(dot(n, sun), eta)));
    }
    return largest / (irradiance * transmittedCosine(1, eta));
}

TEST(EnvironmentIrradiance, OfOnePixelHasTheStatedError) {
    for (const auto& [eta, error] : {std::pair{1.0, 6e-3}, {1.1, 1.1e-3}, {1.3, 8e-4}, {1.5, 8e-4}, {0.8, 0.2}})
        EXPECT_LT(onePixelError(eta), error) << eta;
}

TEST(EnvironmentIrradiance, OfAUniformSkyIsTheClosedForm) {
    const Environment sky = environment(Image(64, 32, {1, 1, 1, 1}));
    for (const auto& [eta, value] : {std::pair{1.3, 2.94954}, {1.5, 2.85326}, {1.0, pi}}) {
        const EnvironmentIrradiance table(sky, eta);
        for (const Vec3f n : {Vec3f{0, 1, 0}, Vec3f{0, -1, 0}, Vec3f{1, 0, 0}, Vec3f{0.36f, 0.48f, -0.8f}})
            EXPECT_NEAR(table(n).g, value, 1e-5);  // digits of the closed form, float
    }
}

TEST(EnvironmentIrradiance, AgreesWithDirectQuadratureOnARealSky) {
    const std::string path = SEARCHLIGHT_SOURCE_DIR "/../shared/data/envmaps/venice_sunset_1k.hdr";
    if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not here";
    const Environment sky(EnvironmentLight{.path = path, .rotation_deg = 50});
    const EnvironmentIrradiance table(sky, 1.3);
    for (int i = 0; i < 40; ++i) {
        const double y = 1 - (i + 0.5) / 20, turn = i * 2.399963229728653;
        const Vec3 n{std::sqrt(1 - y * y) * std::sin(turn), y, std::sqrt(1 - y * y) * std::cos(turn)};
        Rgb sum;
        for (int v = 0; v < 512; ++v)
            for (int u = 0; u < 1024; ++u) {
                const double theta = pi * (v + 0.5) / 512, phi = 2 * pi * (u + 0.5) / 1024 - pi - 50 * pi / 180;
                const Vec3 wi{std::sin(theta) * std::sin(phi), std::cos(theta), -std::sin(theta) * std::cos(phi)};
                const double cosine = dot(wi, n);
                if (cosine <= 0) continue;
                const Rgba& p = sky.picture().at(u, v);
                sum = sum + (transmittedCosine(cosine, 1.3) * std::sin(theta) * pi / 512 * 2 * pi / 1024) *
                                Rgb{p.r, p.g, p.b};
            }
        const Rgb got = toDouble(table(toFloat(n)));
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(got[c] / sum[c], 1, 0.005) << "normal " << n.x << " " << n.y;
    }
}

TEST(EnvironmentIrradiance, DoesNotDependOnThreads) {
    const Environment sky = environment(brightPixel(64, 32, 5, 9));
    const EnvironmentIrradiance one(sky, 1.3, 1), all(sky, 1.3);
    for (const Vec3f n : {Vec3f{0, 1, 0}, Vec3f{0.6f, 0, -0.8f}}) EXPECT_EQ(one(n), all(n));
}

}  // namespace
}  // namespace searchlight
