#include "kernel/preintegrated.h"

#include <cmath>
#include <numbers>

#include "kernel/profiles.h"
#include "kernel/taps.h"

namespace searchlight {
namespace {

constexpr double pi = std::numbers::pi;

TEST(Preintegrated, LineOfAGaussianIsAGaussian) {
    const GroundTruth truth = radialTruth([](double r) { return std::exp(-r * r / 2); }, 1e-4, 8);
    const SeparableKernel kernel = preintegrated(truth);
    for (const double x : {0.0, 0.1, 0.5, 1.0, 2.0, 4.0})
        EXPECT_NEAR(kernel.terms[0].lines[0](x), std::exp(-x * x / 2) / std::sqrt(2 * pi), 1e-5) << x;
}

TEST(Preintegrated, LineOfAnExponentialIsABesselFunction) {
    // The integral of exp(-sqrt(x^2 + y^2)) over y is 2 |x| K1(|x|); its total over the plane is 2 pi.
    const GroundTruth truth = radialTruth([](double r) { return std::exp(-r); }, 1e-4, 40);
    const LineKernel line = preintegrated(truth).terms[0].lines[0];
    for (const double x : {0.01, 0.1, 1.0, 3.0, 10.0}) {
        const double exact = x * std::cyl_bessel_k(1.0, x) / pi;
        EXPECT_NEAR(line(x), exact, 1e-4 * exact) << x;  // the slope of a cubic that is exact in its integral
    }
}

TEST(Preintegrated, PeakThatGrowsAs1OverRCostsNoEnergy) {
    // exp(-r) / r, whose line 2 K0(x) is infinite at 0.
    const GroundTruth truth = radialTruth([](double r) { return std::exp(-r) / r; }, 1e-7, 40);
    const LineKernel line = preintegrated(truth).terms[0].lines[0];
    EXPECT_NEAR(line(1.0), std::cyl_bessel_k(0.0, 1.0) / pi, 1e-5);
    // The integral of K0 from 0 to 0.1 is 0.3426, by its series: x (1 - gamma - ln(x / 2)) + O(x^3).
    const double x = 0.01;
    EXPECT_NEAR(line.integral(0, x), x * (1 - std::numbers::egamma - std::log(x / 2)) / pi, 1e-6);
    EXPECT_NEAR(line.mass(), 1, 1e-12);
}

TEST(Preintegrated, KeepsEnergyAndLeavesAChannelThatDoesNotScatterAlone) {
    const SeparableKernel kernel = preintegrated(radialTruth([](double r) { return std::exp(-r); }, 1e-4, 40));
    const Rgb mass = kernel.mass();
    EXPECT_NEAR(mass.r, 1, 1e-12);
    EXPECT_NEAR(mass.g, 1, 1e-12);
    EXPECT_EQ(mass.b, 1);
    EXPECT_EQ(kernel.terms[0].lines[2].delta(), 1);
}

TEST(Taps, KeepEnergyAtEveryCountAndWidth) {
    const SeparableKernel kernel = preintegrated(radialTruth([](double r) { return std::exp(-r); }, 1e-4, 40));
    for (const int count : {3, 7, 17, 41})
        for (const double rest : {0.1, 0.01, 1e-4}) {
            const Taps taps = sampleTaps(kernel, quadraticOffsets(count, tapExtent(kernel, rest)));
            ASSERT_EQ(taps.terms[0].weights.size(), static_cast<std::size_t>(count));
            for (int c = 0; c < Rgb::channels; ++c) EXPECT_NEAR(taps.mass()[c], 1, 1e-12);
            EXPECT_EQ(taps.terms[0].offsets_mm[static_cast<std::size_t>(count) / 2], 0);
            EXPECT_EQ(taps.terms[0].delta, (Rgb{0, 0, 1}));
        }
}

TEST(Taps, OutermostOneLeavesTheRestThatItIsAskedFor) {
    const SeparableKernel kernel = preintegrated(radialTruth([](double r) { return std::exp(-r); }, 1e-4, 40));
    const double extent = tapExtent(kernel, 0.02);
    // Found between the nodes of the line as if its integral were straight there.
    EXPECT_NEAR(2 * kernel.terms[0].lines[0].integral(extent, 40), 0.02, 1e-4);
}

}  // namespace
}  // namespace searchlight
