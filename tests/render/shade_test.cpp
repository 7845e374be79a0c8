#include "render/shade.h"

#include <hwy/highway.h>

#include <cmath>
#include <numbers>

#include "instruction_sets.h"
#include "model/physics.h"

namespace searchlight {
namespace {

Image composed(const VisibleSurface& visible, const std::vector<Rgbf>& radiance, const std::vector<Rgbf>& coat,
               const Image& background) {
    Image picture(1, 1, {9, 9, 9, 9});  // what was there before leaves nothing
    composite(visible, radiance, coat, background, 0, picture);
    return picture;
}

// Samples at the origin that are seen under the cosines given.
VisibleSurface seenUnder(const std::vector<double>& cosines) {
    VisibleSurface visible{.width = static_cast<int>(cosines.size()), .height = 1, .eye = {0, 0, 1000}};
    for (std::size_t i = 0; i < cosines.size(); ++i) {
        const double sine = std::sqrt(1 - cosines[i] * cosines[i]);
        visible.pixels.push_back(static_cast<std::uint32_t>(i));
        visible.coverage.push_back(1);
        visible.positions.push_back({});
        visible.normals.push_back(toFloat(Vec3{sine, 0, cosines[i]}));
        visible.geometric_normals.push_back(visible.normals.back());
    }
    return visible;
}

TEST(Shade, RadianceOverTheHemisphereIsExitance) {
    // T21 goes as the cosine near 0, so midpoints converge as n^-2.
    constexpr int n = 4000;
    std::vector<double> cosines;
    for (int i = 0; i < n; ++i) cosines.push_back((i + 0.5) / n);
    for (const double eta : {1.0, 1.3, 1.5, 1 / 1.5}) {
        const std::vector<Rgbf> exitance(n, Rgbf{0.25f, 1, 3});
        std::vector<Rgbf> radiance;
        exitRadiance(seenUnder(cosines), exitance, eta, 0, radiance);
        Rgb flux;
        for (int i = 0; i < n; ++i)
            flux = flux + (2 * std::numbers::pi * cosines[static_cast<std::size_t>(i)] / n) *
                              toDouble(radiance[static_cast<std::size_t>(i)]);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(flux[c] / toDouble(exitance[0])[c], 1, 1e-5) << eta;
    }
}

TEST(Shade, TransmittanceIsFresnelsUpToGrazingAngles) {
    // Float in a product without differences: some roundings. 37 samples end within a vector.
    std::vector<double> cosines;
    for (int i = 0; i < 37; ++i) cosines.push_back(std::pow(10.0, -i / 8.0));
    for (const std::int64_t target : {HWY_AVX3, HWY_AVX2, HWY_SSE4}) {
        if (!hasInstructionSet(target)) continue;
        hwy::SetSupportedTargetsForTest(target);
        for (const double eta : {1.0, 1.3, 1.5, 1 / 1.3}) {
            std::vector<Rgbf> radiance;
            exitRadiance(seenUnder(cosines), std::vector<Rgbf>(cosines.size(), Rgbf{1, 1, 1}), eta, 1, radiance);
            const double normalizer = std::numbers::pi * (1 - 2 * Physics<double>::fresnelMoment(1, 1 / eta));
            for (std::size_t i = 0; i < cosines.size(); ++i) {
                const double expected = (1 - Physics<double>::fresnelReflectance(cosines[i], 1 / eta)) / normalizer;
                // The cosine itself is rounded by 1e-7: near total reflection T21 goes as the root of the rest.
                EXPECT_NEAR(radiance[i].g, expected, 2e-5 * expected + (eta < 1 ? 1e-3 : 1e-7))
                    << eta << " " << cosines[i];
            }
        }
        hwy::SetSupportedTargetsForTest(0);
    }
}

// A vertex in a fold has a normal that points away from all that is seen of its triangles.
TEST(Shade, NormalsThatTheirTrianglesBelieNeitherDarkenNorBrighten) {
    const auto turned = [](double degrees) {
        const double angle = degrees * std::numbers::pi / 180;
        return toFloat(Vec3{std::sin(angle), 0, std::cos(angle)});
    };
    // Triangles at 50 degrees to the eye; normals turned further away from it, and towards it.
    VisibleSurface visible = seenUnder(std::vector<double>(6, 1.0));
    const double normals[] = {50, 130, 96, 70, 75, 10};
    for (std::size_t i = 0; i < 6; ++i) {
        visible.geometric_normals[i] = turned(50);
        visible.normals[i] = turned(normals[i]);
    }
    std::vector<Rgbf> radiance, expected;
    exitRadiance(visible, std::vector<Rgbf>(6, Rgbf{1, 1, 1}), 1.5, 1, radiance);
    const VisibleSurface smooth =
        seenUnder({std::cos(70 * std::numbers::pi / 180), std::cos(75 * std::numbers::pi / 180)});
    exitRadiance(smooth, std::vector<Rgbf>(2, Rgbf{1, 1, 1}), 1.5, 1, expected);
    EXPECT_FLOAT_EQ(radiance[1].r, radiance[0].r) << "80 degrees apart: the triangle's";
    EXPECT_FLOAT_EQ(radiance[2].r, radiance[0].r) << "46 degrees apart: the triangle's";
    // Within 25 degrees the normal has its way as long as its cosine is more than half of the triangle's.
    EXPECT_NEAR(radiance[3].r, expected[0].r, 1e-6);
    EXPECT_GT(radiance[4].r, expected[1].r);
    EXPECT_GT(radiance[5].r, radiance[0].r) << "a normal towards the eye is believed";
}

TEST(Shade, CoverageIsAlphaOverTheBackground) {
    VisibleSurface visible = seenUnder({1, 1, 1});
    visible.coverage = {1, 0.25f, 0.25f};
    visible.pixels = {0, 1, 1};
    const std::vector<Rgbf> radiance{{1, 2, 3}, {4, 4, 4}, {8, 8, -8}};
    const Image alone = composed(visible, radiance, {}, Image(3, 1));
    EXPECT_EQ(alone.at(0, 0), (Rgba{1, 2, 3, 1}));
    EXPECT_EQ(alone.at(1, 0), (Rgba{3, 3, 1, 0.5f}));  // a negative radiance counts as 0
    EXPECT_EQ(alone.at(2, 0), (Rgba{0, 0, 0, 0}));
    const Image before = composed(visible, radiance, {}, Image(3, 1, {2, 2, 2, 1}));
    EXPECT_EQ(before.at(0, 0), (Rgba{1, 2, 3, 1}));
    EXPECT_EQ(before.at(1, 0), (Rgba{4, 4, 2, 1}));
    EXPECT_EQ(before.at(2, 0), (Rgba{2, 2, 2, 1}));
    const std::vector<Rgbf> coat{{1, 1, 1}, {0, 0, 0}, {4, 0, 0}};
    EXPECT_EQ(composed(visible, radiance, coat, Image(3, 1)).at(0, 0), (Rgba{2, 3, 4, 1}));
}

TEST(Shade, ExposureBringsTheBrightPartsNearWhite) {
    VisibleSurface visible = seenUnder(std::vector<double>(100, 1.0));
    std::vector<Rgbf> radiance(100, Rgbf{0.05f, 0.1f, 0.1f});
    radiance[7] = {50, 50, 50};  // a highlight that may burn out
    EXPECT_NEAR(displayExposure(visible, radiance, 0), 3, 1e-5);
    EXPECT_EQ(displayExposure(visible, std::vector<Rgbf>(100), 0), 0);
}

}  // namespace
}  // namespace searchlight
