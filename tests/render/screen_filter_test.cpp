#include "render/screen/screen_filter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "kernel/filter.h"
#include "kernel/preintegrated.h"
#include "kernel/taps.h"
#include "screen_plane.h"

namespace searchlight {
namespace {

using test::gaussianTaps;
using test::ScreenPlane;

constexpr FilterAxes all_axes[] = {FilterAxes::surface, FilterAxes::screen, FilterAxes::turned};
constexpr FilterTrust all_trusts[] = {FilterTrust::all, FilterTrust::depth, FilterTrust::distance};

TEST(ScreenFilter, EvenLightStaysAsItIs) {
    // In the plane, at the borders of the picture, and where the plane ends.
    ScreenPlane plane(100, 50, 30);
    const std::size_t half = plane.samples.count / 2;
    for (auto* list : {&plane.visible.positions, &plane.visible.normals, &plane.visible.geometric_normals})
        list->resize(half);
    plane.visible.pixels.resize(half);
    plane.visible.coverage.resize(half);
    plane.samples = screenSamples(plane.view, plane.visible, 1);
    const std::vector<Rgbf> light = plane.light([](double, double) { return 3; });
    for (const FilterAxes axes : all_axes)
        for (const FilterTrust trust : all_trusts)
            for (const Rgbf& found :
                 filterScreen(plane.samples, light, gaussianTaps(2, 0.2), {.axes = axes, .trust = trust}))
                ASSERT_NEAR(found.r, 3, 1e-4);  // rounding of 41 terms in single precision
}

// A wave on the plane keeps its shape under any even kernel; a Gaussian damps it by exp(-sigma^2 k^2 / 2), whatever its
// direction. So the same must come out from every distance, field of view and tilt.
double waveError(const ScreenPlane& plane, double along, double sigma, const ScreenFilterOptions& options) {
    constexpr double wave = 1.2;  // radians per mm
    const double ks = wave * std::cos(along), kt = wave * std::sin(along);
    const auto shape = [&](double s, double t) { return std::cos(ks * s + kt * t + 0.4); };
    const std::vector<Rgbf> light = plane.light([&](double s, double t) { return 1 + shape(s, t); });
    const std::vector<Rgbf> found = filterScreen(plane.samples, light, gaussianTaps(sigma), options);
    double worst = 0;
    for (std::size_t i = 0; i < found.size(); ++i) {
        const Vec3 p = toDouble(plane.visible.positions[i]);
        const double s = dot(p, plane.s), t = dot(p, plane.t);
        if (s * s + t * t > 9) continue;  // 3 mm around what the camera looks at, away from the picture's borders
        const double expected = 1 + std::exp(-0.5 * sigma * sigma * wave * wave) * shape(s, t);
        worst = std::max(worst, std::abs(found[i].r - expected));
    }
    return worst;
}

TEST(ScreenFilter, TiltDistanceAndFieldOfViewDoNotChangeTheResultInMillimetres) {
    for (const auto& [distance, tilt, about, field] : {std::tuple{60.0, 0.0, 0.0, 30.0},
                                                       {120.0, 0.0, 0.0, 15.0},
                                                       {60.0, 45.0, 0.0, 30.0},
                                                       {60.0, 45.0, 90.0, 30.0},
                                                       {50.0, 50.0, 37.0, 35.0}}) {
        const ScreenPlane plane(distance, tilt, about, 300, field);
        for (const double along : {0.8, 2.2})
            // Linear interpolation between pixels 0.11 mm apart, 0.17 mm where the plane is tilted, damps this wave by
            // up to (0.17 * 1.2)^2 / 8 = 0.5 % in either pass.
            EXPECT_LT(waveError(plane, along, 0.7, {.axes = FilterAxes::surface}), 0.011)
                << distance << " mm, tilt " << tilt << " about " << about << ", wave at " << along;
    }
}

TEST(ScreenFilter, AxesOfThePictureAreThoseOfTheSurfaceOnlyWhereItFacesTheCamera) {
    const ScreenFilterOptions screen{.axes = FilterAxes::screen, .trust = FilterTrust::all};
    EXPECT_LT(waveError(ScreenPlane(60, 0, 0, 400), 0.8, 0.7, screen), 0.007);
    // At 60 degrees a step in the picture is twice as long on the surface: exp(-0.35) would be exp(-1.4).
    EXPECT_GT(waveError(ScreenPlane(60, 60, 0, 400), std::numbers::pi / 2, 0.7, screen), 0.2);
}

TEST(ScreenFilter, TermsAtAnAngleBlurARotationallyEvenKernelAlike) {
    const ScreenPlane plane(60, 40, 20, 300);
    const auto blob = [](double s, double t) { return std::exp(-s * s - t * t); };
    const std::vector<Rgbf> light = plane.light(blob);
    const auto straight = filterScreen(plane.samples, light, gaussianTaps(0.8), {});
    const auto turned = filterScreen(plane.samples, light, gaussianTaps(0.8, 0, 41, 45), {});
    const std::size_t at = plane.middle();
    // Widths add as squares: 1/2 and 0.64 along each axis.
    EXPECT_NEAR(straight[at].r, 0.5 / (0.5 + 0.64), 0.004);  // pixels of 0.11 to 0.14 mm
    EXPECT_NEAR(turned[at].r, straight[at].r, 0.002);
}

TEST(ScreenFilter, TurnedAxesBlurByTheMeanOfTheLineOverAllAnglesTwice) {
    // Of a Gaussian's line the mean transform is exp(-u) I0(u), u = sigma^2 omega^2 / 4; the light's is exp(-omega^2 /
    // 4).
    double expected = 0;
    for (double omega = 0.005; omega < 12; omega += 0.01) {
        const double u = 0.16 * omega * omega, line = std::exp(-u) * std::cyl_bessel_i(0.0, u);
        expected += 0.01 * 0.5 * omega * std::exp(-0.25 * omega * omega) * line * line;
    }
    const ScreenPlane plane(60, 40, 20, 100, 20);
    const std::vector<Rgbf> light = plane.light([](double s, double t) { return std::exp(-s * s - t * t); });
    constexpr int frames = 32;
    double mean = 0;
    for (int frame = 0; frame < frames; ++frame) {
        const auto found =
            filterScreen(plane.samples, light, gaussianTaps(0.8, 0, 17), {.axes = FilterAxes::turned, .frame = frame});
        mean += static_cast<double>(found[plane.middle()].r) / frames;
    }
    // Interpolation between pixels of 0.23 to 0.3 mm widens the light by up to 3 percent; perpendicular lines would
    // give 0.439.
    EXPECT_NEAR(mean, expected, 0.02);
}

TEST(ScreenFilter, TurnsAreUniformAndThoseOfBothPassesAsGoodAsIndependent) {
    double first = 0, second = 0, both = 0;
    constexpr int n = 64, frames = 4;
    for (int frame = 0; frame < frames; ++frame)
        for (int y = 0; y < n; ++y)
            for (int x = 0; x < n; ++x) {
                const double a = std::cos(2 * turnOfPixel(x, y, frame, false));
                const double b = std::cos(2 * turnOfPixel(x + 3, y + 1, frame, true));
                first += a / (n * n * frames);
                second += b / (n * n * frames);
                both += a * b / (n * n * frames);
            }
    // A pattern that is even by design; of independent angles the product would scatter by 1 / 256.
    EXPECT_NEAR(first, 0, 0.01);
    EXPECT_NEAR(second, 0, 0.01);
    // Within a frame the passes differ by a constant for each way from pixel to pixel: four of them are averaged.
    EXPECT_NEAR(both, 0, 0.25);
}

TEST(ScreenFilter, AStepOnAFacingSlabIsTheIntegralOfTheLine) {
    // R_d that falls exponentially over 1 mm: its line is known in closed form, and pre-integration is exact for a
    // step.
    std::vector<double> radii;
    std::vector<Rgb> values;
    for (int i = 0; i <= 1200; ++i) {
        radii.push_back(1e-4 * std::pow(3e5, i / 1200.0));
        const double value = std::exp(-radii.back());
        values.push_back({value, value, value});
    }
    const SeparableKernel kernel = preintegrated(GroundTruth(Profile(radii, values)));
    const ScreenPlane plane(60, 0, 0, 400);
    const std::vector<Rgbf> light = plane.light([](double s, double) { return s > 0 ? 1 : 0; });
    for (const int taps : {201, 17}) {
        const Taps sampled = sampleTaps(kernel, quadraticOffsets(taps, tapExtent(kernel, 1e-3)));
        // Of the tap in whose cell the step lies all is counted or nothing; and the step is spread over a pixel of 0.08
        // mm, of a line as high as 1/pi per mm.
        double tolerance = 0.5 * 0.08 / std::numbers::pi;
        double heaviest = 0;
        for (std::size_t k = 0; k < sampled.terms[0].weights.size(); ++k)
            heaviest = std::max(heaviest, sampled.terms[0].weight(k).r);
        tolerance += heaviest;
        const std::vector<Rgbf> found = filterScreen(plane.samples, light, sampled, {});
        for (std::size_t i = 0; i < found.size(); ++i) {
            const double s = plane.visible.positions[i].x, t = plane.visible.positions[i].y;
            if (std::abs(t) > 0.2 || std::abs(s) > 5) continue;
            const double lit = kernel.terms[0].lines[0].integral(-30, s);
            ASSERT_NEAR(found[i].r, lit, tolerance) << s << " mm, " << taps << " taps";
        }
    }
}

TEST(ScreenFilter, LightStaysOnItsSideOfADepthJump) {
    // The right half of the picture is 20 mm further away and dark.
    const ScreenPlane near(100, 0, 0), far(120, 0, 0);
    VisibleSurface visible = near.visible;
    for (std::size_t i = 0; i < visible.positions.size(); ++i)
        if (visible.pixels[i] % 200 >= 100) {
            const Vec3f p = far.visible.positions[i];
            visible.positions[i] = {p.x, p.y, p.z - 20};
        }
    const ScreenSamples samples = screenSamples(near.view, visible, 1);
    std::vector<Rgbf> light(samples.count);
    for (std::size_t i = 0; i < light.size(); ++i)
        if (visible.pixels[i] % 200 < 100) light[i] = {1, 1, 1};
    const std::size_t dark_side = 100 * 200 + 102, lit_side = 100 * 200 + 97;
    const auto found = [&](FilterAxes axes, FilterTrust trust) {
        return filterScreen(samples, light, gaussianTaps(2), {.axes = axes, .trust = trust});
    };
    for (const FilterAxes axes : all_axes) {
        const auto blind = found(axes, FilterTrust::all);
        EXPECT_GT(blind[dark_side].r, 0.2f);
        EXPECT_LT(blind[lit_side].r, 0.8f);
        for (const FilterTrust trust : {FilterTrust::depth, FilterTrust::distance}) {
            const auto seeing = found(axes, trust);
            // (1 + 10 / (4 * 0.8))^-4 per pass, of what a tap with an offset of 3 mm brings: below 1 %.
            EXPECT_LT(seeing[dark_side].r, 0.01f);
            EXPECT_GT(seeing[lit_side].r, 0.99f);
        }
    }
}

TEST(ScreenFilter, FallbackSaysWhatStandsForWhatIsNotSeen) {
    const ScreenPlane plane(100, 0, 0);
    const std::vector<Rgbf> light = plane.light([](double, double) { return 1; });
    // At the picture's left border half of a pass along the row falls outside, nothing of one along the column.
    const std::size_t border = 100 * 200;
    const auto found = [&](double fallback) {
        return filterScreen(plane.samples, light, gaussianTaps(2), {.fallback = fallback})[border].r;
    };
    EXPECT_NEAR(found(1), 1, 1e-4);
    // The pixel itself, 0.27 mm of a line as high as 0.2 per mm, lies on the seen side.
    EXPECT_NEAR(found(0), 0.5, 0.05);
    EXPECT_NEAR(found(0.5), 0.5 * (found(0) + found(1)), 1e-4);
}

TEST(ScreenFilter, StrengthIsAWidthPerPlace) {
    const ScreenPlane plane(60, 0, 0, 300);
    const std::vector<Rgbf> light = plane.light([](double s, double t) { return std::exp(-s * s - t * t); });
    const std::vector<float> half(plane.samples.count, 0.5f), none(plane.samples.count, 0.0f);
    const auto narrow = filterScreen(plane.samples, light, gaussianTaps(0.4), {});
    const auto halved = filterScreen(plane.samples, light, gaussianTaps(0.8), {.strength = half});
    const auto sharp = filterScreen(plane.samples, light, gaussianTaps(0.8), {.strength = none});
    for (std::size_t i = 0; i < light.size(); ++i) {
        ASSERT_NEAR(narrow[i].g, halved[i].g, 1e-5);
        ASSERT_NEAR(sharp[i].g, light[i].g, 2e-3);  // a place within rounding of a pixel's middle
    }
}

TEST(ScreenFilter, TermsAddUpAndThreadsChangeNothing) {
    const ScreenPlane plane(60, 30, 70, 200);
    const std::vector<Rgbf> light = plane.light([](double s, double) { return s > 0 ? 1 : 0.1; });
    Taps both = gaussianTaps(0.5), wide = gaussianTaps(1.5);
    wide.terms[0].scale = {-0.25, 0.5, 0.1};
    const auto first = filterScreen(plane.samples, light, both, {.trust = FilterTrust::all, .threads = 1});
    const auto second = filterScreen(plane.samples, light, wide, {.trust = FilterTrust::all, .threads = 1});
    both.terms.push_back(wide.terms[0]);
    const auto sum = filterScreen(plane.samples, light, both, {.trust = FilterTrust::all, .threads = 1});
    const auto again = filterScreen(plane.samples, light, both, {.trust = FilterTrust::all, .threads = 3});
    for (std::size_t i = 0; i < sum.size(); ++i) {
        ASSERT_NEAR(sum[i].r, first[i].r + second[i].r, 1e-6);
        ASSERT_NEAR(sum[i].b, first[i].b + second[i].b, 1e-6);
    }
    EXPECT_EQ(sum, again);
}

// The outline of something near before something far: both have samples in the pixel, and each keeps to its own.
TEST(ScreenFilter, SamplesThatShareAPixelKeepTheirOwnSurface) {
    ScreenPlane plane(100, 0, 0);
    VisibleSurface& visible = plane.visible;
    const std::size_t at = 100 * 200 + 100;
    const auto insert = [&](auto& list, auto value) { list.insert(list.begin() + at + 1, value); };
    Vec3f position = visible.positions[at];
    position.z = 40;
    insert(visible.pixels, visible.pixels[at]);
    insert(visible.coverage, 0.25f);
    insert(visible.positions, position);
    insert(visible.normals, visible.normals[at]);
    insert(visible.geometric_normals, visible.geometric_normals[at]);
    visible.coverage[at] = 0.75f;
    const ScreenSamples samples = screenSamples(plane.view, visible, 1);
    EXPECT_EQ(samples.standing, samples.count - 1);
    EXPECT_EQ(samples.source.back(), at + 1);
    std::vector<Rgbf> light(samples.count, Rgbf{1, 1, 1});
    light[at + 1] = {5, 5, 5};
    const auto found = filterScreen(samples, light, gaussianTaps(1), {});
    EXPECT_NEAR(found[at].r, 1, 1e-4);
    EXPECT_NEAR(found[at + 1].r, 5, 1e-3);
}

}  // namespace
}  // namespace searchlight
