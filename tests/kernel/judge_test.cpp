#include "kernel/judge.h"

#include <numbers>

#include "kernel/burley_width.h"
#include "kernel/methods.h"
#include "kernel/optimised.h"
#include "kernel/preintegrated.h"
#include "kernel/profiles.h"
#include "kernel/taps.h"

namespace searchlight {
namespace {

TEST(Spectrum, OfALineIsThatOfTheRadialProfile) {
    // Normalized diffusion has a closed transform. The line is known to the cubic through its nodes, 6 % apart.
    const GroundTruth truth = burleyTruth();
    const LineKernel line = preintegrated(truth).terms[0].lines[0];
    for (const double omega : {0.01, 0.1, 1.0, 10.0, 100.0})
        EXPECT_NEAR(line.transform(omega), burleyTransform(1, omega), 2e-5) << omega;
    const RadialSpectrum spectrum(lineSpread(truth), 0.01, 100);
    for (const double omega : {0.0123, 0.77, 5.0, 60.0})
        EXPECT_NEAR(spectrum(omega).g, burleyTransform(0.5, omega), 2e-5) << omega;
    EXPECT_EQ(spectrum(1e-3).r, 1);
}

TEST(Filter, ExactOneTurnsWavesIntoWaves) {
    const GroundTruth truth = burleyTruth();
    const Judge judge(truth, {.size = 64, .side_mm = 20});
    constexpr int a = 3, b = 5;
    Image image(64, 64, {0, 0, 0, 1});
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x)
            image.at(x, y).r = static_cast<float>(std::cos(2 * std::numbers::pi * (a * x + b * y) / 64));
    const Image filtered = exactFilter(image, judge.spectrum(), judge.pixel());
    const double expected = burleyTransform(1, 2 * std::numbers::pi * std::hypot(a, b) / 20);
    for (const int x : {0, 7, 40}) EXPECT_NEAR(filtered.at(x, 11).r, expected * image.at(x, 11).r, 1e-5);
}

TEST(Filter, PreintegratedTapsAreExactForSumsOfFunctionsOfXAndY) {
    // E1(x) + E2(y). Taps on every pixel, whose weights are the line's integrals over it: the only error is that of
    // taking a pixel as constant, and that is sinc(omega / 2) at the waves' frequency, which is divided out.
    const GroundTruth truth = burleyTruth();
    const SeparableKernel kernel = preintegrated(truth);
    constexpr int n = 64, side = 1200;
    const double pixel = 0.05, omega = 2 * std::numbers::pi * 2 / (n * pixel);
    std::vector<double> offsets;
    for (int i = -side; i <= side; ++i) offsets.push_back(i * pixel);
    const Taps taps = sampleTaps(kernel, offsets);
    Image image(n, n, {0, 0, 0, 1});
    for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x)
            image.at(x, y).r = static_cast<float>(std::cos(omega * pixel * x) + 0.5 * std::sin(2 * omega * pixel * y));
    const Image filtered = tapsFilter(image, taps, {.pixel_mm = pixel});
    const auto seen = [&](double w) {
        const double h = 0.5 * w * pixel;
        return kernel.terms[0].lines[0].transform(w) * h / std::sin(h);
    };
    for (const int x : {0, 13, 50})
        for (const int y : {3, 31}) {
            const double exact =
                seen(omega) * std::cos(omega * pixel * x) + 0.5 * seen(2 * omega) * std::sin(2 * omega * pixel * y);
            EXPECT_NEAR(filtered.at(x, y).r, exact, 2e-3) << x << " " << y;
        }
}

TEST(Filter, ConvergesOnTheExactOneForAdditivelySeparableSignals) {
    // The transform along an axis of many quadratic taps, against the ground truth: to 1e-6 with enough of them.
    const GroundTruth truth = radialTruth([](double r) { return std::exp(-r); }, 1e-4, 40);
    const SeparableKernel kernel = preintegrated(truth);
    const double omega = 0.7, exact = kernel.terms[0].lines[0].transform(omega);
    const Taps taps = sampleTaps(kernel, quadraticOffsets(8001, kernel.extent_mm));
    EXPECT_NEAR(tapsTransform(taps, omega, 0).r, exact, 1e-6);
    EXPECT_NEAR(tapsTransform(taps, 0, omega).r, exact, 1e-6);
    // exp(-r) has the transform (1 + omega^2)^-3/2; its profile is flat below 1e-4 and cut at 40.
    EXPECT_NEAR(exact, std::pow(1 + omega * omega, -1.5), 1e-6);
}

TEST(Judge, EveryMethodKeepsEnergy) {
    const GroundTruth truth = burleyTruth();
    const Judge judge(truth, {.size = 32});
    for (const Method& method : methods())
        for (const bool placed : {false, true}) {
            const MadeKernel made = makeKernel(
                truth, judge.cells(),
                {.method = std::string(method.name), .placed = placed, .rank = method.name == "turned" ? 1 : 2});
            for (int c = 0; c < Rgb::channels; ++c) EXPECT_NEAR(made.taps.mass()[c], 1, 1e-6) << method.name;
        }
}

TEST(Judge, OptimisedTapsBeatAllOthersAtEqualPasses) {
    const GroundTruth truth = burleyTruth();
    const Judge judge(truth);
    const auto error = [&](const MethodOptions& options) {
        return Judge::overall(judge.imageRms(makeKernel(truth, judge.cells(), options).taps));
    };
    const double one = error({.method = "optimised"}), two = error({.method = "optimised", .rank = 2});
    for (const double k : {0.0, 1.0, 2.0}) EXPECT_LT(one, error({.method = "guided", .guided = {.k = k}}));
    for (const char* method : {"preintegrated", "svd", "manual", "skin"}) EXPECT_LT(one, error({.method = method}));
    EXPECT_LT(two, error({.method = "svd", .rank = 2}));
    EXPECT_LT(two, error({.method = "gaussians", .count = 2}));
    EXPECT_LT(two, 0.7 * one);
}

TEST(Judge, TapsForTurnedAxesComeNearTheConvolutionInTwoPasses) {
    // The line's mean over all angles, twice, can be any radial kernel; what is left over 8 frames is grain.
    const GroundTruth truth = burleyTruth();
    const Judge judge(truth, {.size = 64});
    const auto error = [&](const MethodOptions& options) {
        return Judge::overall(judge.imageRms(makeKernel(truth, judge.cells(), options).taps));
    };
    const double turned = error({.method = "turned"});
    EXPECT_LT(turned, 0.5 * error({.method = "preintegrated"}));
    EXPECT_LT(turned, 0.6 * error({.method = "optimised"}));
}

TEST(Judge, FindsTheWidthOfAKernelInOtherUnits) {
    const GroundTruth truth = burleyTruth();
    const Judge judge(truth, {.size = 64});
    Taps taps = quadraticTaps(preintegrated(truth), 41);
    const double own = judge.bestWidth(taps);  // not 1: sampling widens a kernel
    EXPECT_NEAR(own, 0.9, 0.1);
    for (double& offset : taps.terms[0].offsets_mm) offset /= 25.4;
    EXPECT_NEAR(judge.bestWidth(taps), 25.4 * own, 0.02 * 25.4);  // found in steps of 1 %
}

TEST(Signals, RepeatAndStayWithinTheirRange) {
    for (const Signal& signal : signals()) {
        const Image image = signal.make(32);
        float low = 1, high = 0;
        for (const Rgba& pixel : image.pixels) {
            low = std::min({low, pixel.r, pixel.g, pixel.b});
            high = std::max({high, pixel.r, pixel.g, pixel.b});
        }
        EXPECT_GE(low, 0) << signal.name;
        EXPECT_LE(high, 1) << signal.name;
        EXPECT_GT(high - low, 0.1) << signal.name;
    }
}

}  // namespace
}  // namespace searchlight
