#include "light/light_sampler.h"

#include <random>

#include "light/places.h"
#include "light/transmitted_cosine.h"

namespace searchlight {
namespace {

using test::litBy;
using test::PictureFile;

// The mean over n samples of what crosses into a surface of normal n at a position, without shadows.
struct Mean {
    double value = 0, error = 0;
};
Mean crossed(const LightSampler& sampler, Vec3 position, Vec3 normal, int n) {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> uniform(0, 1);
    double sum = 0, squares = 0;
    for (int i = 0; i < n; ++i) {
        const double choice = uniform(random), u = uniform(random), v = uniform(random);
        const LightSample sample = sampler.sample(position, choice, u, v);
        const double value = sample.irradiance_over_pdf.g * transmittedCosine(dot(sample.wi, normal), 1.3);
        sum += value, squares += value * value;
    }
    return {sum / n, std::sqrt(std::max(0.0, squares / n - sum / n * sum / n) / n)};
}

TEST(LightSampler, EstimatesWhatIrradianceComputes) {
    Image picture(32, 16, {0.2f, 0.3f, 0.5f, 1});
    picture.at(20, 4) = {90, 60, 30, 1};
    const PictureFile sky("sky.pfm", picture);
    Image panes(2, 2, {0.25f, 0.5f, 1, 1});
    panes.at(0, 0) = {1, 1, 0.5f, 1};
    const PictureFile glass("glass.pfm", panes);
    const Object object = test::sphere();
    DirectionalLight filtered{{0.2, 0.5, 1}, {2, 2, 2}, 20};
    filtered.filter = glass.path();
    const EnvironmentLight environment{.path = sky.path(), .intensity = {1, 2, 3}, .rotation_deg = 30};
    const std::vector<std::vector<Light>> scenes{
        {DirectionalLight{{1, 1, 1}, {1, 2, 3}}},
        {DirectionalLight{{0, 1, 0.5}, {1, 2, 3}, 90}},
        {filtered},
        {PointLight{{0.2, 1, 1.5}, {4, 5, 6}}},
        {environment},
        {filtered, PointLight{{0.2, 1, 1.5}, {4, 5, 6}}, environment, DirectionalLight{{-1, 1, 1}}},
    };
    const std::vector<Vec3f> normals{{0, 0, 1}, {0, 0.6f, 0.8f}, {-0.6f, 0, 0.8f}};
    std::vector<Vec3f> positions;
    for (const Vec3f& n : normals) positions.push_back(toFloat(5.0 * toDouble(n)));
    Observer observer;
    for (const std::vector<Light>& lights : scenes) {
        const Scene scene = litBy(lights);
        const LightSampler sampler(scene, object);
        EXPECT_FALSE(sampler.dark());
        IrradianceOptions options;
        options.disc_samples = 4096;
        LitPoints points = prepareLitPoints({positions, normals}, object, nullptr, LitNormals::shading, 0, observer);
        points.spacing_mm = 0;  // three points would average the filter over a third of the sphere each
        const Irradiance lit = computeIrradiance(points, scene, object, nullptr, options, observer);
        for (std::size_t i = 0; i < normals.size(); ++i) {
            const Mean mean = crossed(sampler, toDouble(positions[i]), toDouble(normals[i]), 1 << 16);
            // Four standard errors. 0.2 %: the harmonics, the sums over the disc.
            EXPECT_NEAR(mean.value, lit.transmitted[i].g, 4 * mean.error + 0.002 * lit.transmitted[i].g)
                << "normal " << i << " of " << lights.size() << " lights";
        }
    }
}

TEST(LightSampler, ReportsDensityAndDistance) {
    const Object object = test::sphere();
    const LightSample point = LightSampler(litBy({PointLight{{0, 2, 0}}}), object).sample({0, 5, 0}, 0.5, 0.5, 0.5);
    EXPECT_NEAR(point.distance, 15, 1e-5);  // 20 mm up; the sphere's size in float
    EXPECT_EQ(point.pdf, 0);
    const LightSample sun =
        LightSampler(litBy({DirectionalLight{{0, 1, 0}, {1, 1, 1}, 180}}), object).sample({}, 0.5, 0.5, 0.5);
    EXPECT_NEAR(sun.pdf, 1 / (2 * std::numbers::pi), 1e-12);
    EXPECT_TRUE(std::isinf(sun.distance));
    // Two lights of equal strength: half the density.
    const LightSample of_two =
        LightSampler(litBy({DirectionalLight{{0, 1, 0}, {1, 1, 1}, 180}, DirectionalLight{{0, 1, 0}, {1, 1, 1}, 180}}),
                     object)
            .sample({}, 0.7, 0.5, 0.5);
    EXPECT_NEAR(of_two.pdf, sun.pdf / 2, 1e-12);
}

TEST(LightSampler, WithoutLightIsDark) {
    const Object object = test::sphere();
    EXPECT_TRUE(LightSampler(litBy({}), object).dark());
    const LightSampler off(litBy({DirectionalLight{{0, 1, 0}, {0, 0, 0}}}), object);
    EXPECT_TRUE(off.dark());
    EXPECT_EQ(off.sample({}, 0.1, 0.2, 0.3).irradiance_over_pdf, Rgb{});
}

}  // namespace
}  // namespace searchlight
