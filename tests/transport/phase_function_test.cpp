#include "transport/walk/phase_function.h"

#include <gtest/gtest.h>
#include <hwy/highway.h>

#include <cmath>
#include <numbers>

#include "illegal/messages.h"
#include "instruction_sets.h"
#include "judge.h"
#include "transport/slab/slab.h"

namespace searchlight {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// Samples of p(cos) at equal steps of the angle.
template <class Density>
PhaseFunction tabulated(int bins, const Density& density) {
    PhaseFunction phase;
    for (int i = 0; i <= bins; ++i) {
        const double angle = 180.0 * i / bins;
        phase.angles_deg.push_back(angle);
        phase.values.push_back(density(std::cos(angle * (std::numbers::pi / 180))));
    }
    return phase;
}

SlabResult walk(const PhaseFunction& phase, double sigma_a, double sigma_s, double thickness_mm, std::uint64_t walks) {
    SlabProblem problem;
    problem.layers = {{.sigma_a = sigma_a, .sigma_s = sigma_s, .thickness_mm = thickness_mm, .phase = phase}};
    SlabOptions options;
    options.walks = walks;
    options.edges_mm = {0, 1};
    options.depth_mm = 1;
    Observer observer;
    return walkSlab(problem, options, observer);
}

TEST(PhaseFunction, TheMeanCosineOfATableOfHenyeyGreensteinIsG) {
    const double g = 0.75;
    const PhaseFunction phase = tabulated(2000, [&](double mu) { return std::pow(1 + g * g - 2 * g * mu, -1.5); });
    EXPECT_NEAR(meanCosine(phase), g, 1e-5);  // of linear pieces
    EXPECT_NEAR(meanCosine(rayleighPhase()), 0, 1e-12);
}

// 2 pi a int p(-mu) mu / (1 + mu) dmu scatters once out of a matched half-space; for Rayleigh's phase function that is
// 3 a / 8 (11 / 6 - 2 log 2).
TEST(PhaseFunction, ScattersOnceAsTheIntegralOfTheTableSays) {
    Judge judge;
    const double albedo = 0.25;
    judge.compare("Rayleigh", walk(rayleighPhase(), 1 - albedo, albedo, infinity, 400'000).R_single,
                  albedo * 3 / 8 * (11.0 / 6 - 2 * std::numbers::ln2));
    // Lobes of 12 degrees: each sees its own part of the table. Of a lobe backwards much leaves, and known well.
    for (const double middle : {96.0, 120.0, 150.0, 174.0}) {
        PhaseFunction lobe{{0, middle - 6, middle, middle + 6, 180}, {0, 0, 1, 0, 0}};
        if (middle + 6 == 180) lobe = {{0, middle - 6, middle, 180}, {0, 0, 1, 0}};
        double total = 0, leaves = 0;
        const int steps = 4000;
        for (std::size_t i = 0; i + 1 < lobe.values.size(); ++i) {
            const double a = std::cos(lobe.angles_deg[i] * (std::numbers::pi / 180));
            const double b = std::cos(lobe.angles_deg[i + 1] * (std::numbers::pi / 180));
            for (int k = 0; k < steps; ++k) {
                const double t = (k + 0.5) / steps, mu = -(a + (b - a) * t);
                const double p = lobe.values[i] + (lobe.values[i + 1] - lobe.values[i]) * t;
                total += p * (a - b) / steps;
                if (mu > 0) leaves += p * (a - b) / steps * mu / (1 + mu);
            }
        }
        judge.compare("lobe", walk(lobe, 1 - albedo, albedo, infinity, 400'000).R_single, albedo * leaves / total);
    }
    judge.expectAgreement();
}

// A peak, and behind it 1e5 bins that share 2 light quanta in a thousand: each is rarer than single precision can
// tell of numbers up to 1e5.
TEST(PhaseFunction, KeepsWhatIsRareInATableOfManyRows) {
    constexpr int bins = 99'999;
    constexpr double behind = 0.002, albedo = 0.25;
    PhaseFunction phase;
    for (int i = 0; i <= bins; ++i) {
        phase.angles_deg.push_back(i == bins ? 180 : 180.0 * i / bins);
        phase.values.push_back(i == 0 ? 1 : 0);
    }
    const double peak = 0.5 * (1 - std::cos(std::numbers::pi / bins));
    for (int i = bins / 2 + 1; i <= bins; ++i) phase.values[static_cast<std::size_t>(i)] = peak * behind / (1 - behind);
    Judge judge;
    // 2 pi int p(-mu) mu / (1 + mu) dmu where p is even behind: 1 - log 2 of what is there, times two.
    judge.compare("even behind", walk(phase, 1 - albedo, albedo, infinity, 1'000'000).R_single,
                  albedo * behind * (1 - std::numbers::ln2));
    judge.expectAgreement();
}

// Van de Hulst's slabs, tests/data/transport/slabs.csv; linear pieces of half a degree change R and T by 1e-5.
TEST(PhaseFunction, TablesOfKnownPhaseFunctionsGiveTheirSlabs) {
    const double g = 0.75;
    const PhaseFunction phase = tabulated(360, [&](double mu) { return std::pow(1 + g * g - 2 * g * mu, -1.5); });
    const PhaseFunction even{{0, 180}, {1, 1}};
    Judge judge;
    const SlabResult hg = walk(phase, 1, 9, 0.2, 500'000), isotropic = walk(even, 0, 1, 1, 500'000);
    judge.compare("R, g 0.75", hg.R, 0.09739464);
    judge.compare("T, g 0.75", {hg.T.mean + hg.T_unscattered.mean, hg.T.standard_error, 0}, 0.66095770);
    judge.compare("R, isotropic", isotropic.R, 0.34132876);
    judge.expectAgreement();
}

// A layer with a table beside one without.
TEST(PhaseFunction, LayersOfBothKindsStandTogether) {
    SlabProblem problem;
    problem.layers = {{.sigma_s = 0.5, .thickness_mm = 1, .phase = PhaseFunction{{0, 180}, {1, 1}}},
                      {.sigma_s = 0.5, .thickness_mm = 1}};
    SlabOptions options;
    options.walks = 500'000;
    options.edges_mm = {0, 1};
    options.depth_mm = 1;
    Observer observer;
    Judge judge;
    judge.compare("R", walkSlab(problem, options, observer).R, 0.34132876);
    judge.expectAgreement();
}

TEST(PhaseFunction, Avx2AndAvx512AgreeBitForBit) {
    if (!hasInstructionSet(HWY_AVX3)) GTEST_SKIP() << "no AVX-512 here";
    const auto on = [](std::int64_t target) {
        hwy::SetSupportedTargetsForTest(target);
        const SlabResult result = walk(rayleighPhase(), 0.1, 1, 2, 50'000);
        hwy::SetSupportedTargetsForTest(0);
        return result.flux;
    };
    EXPECT_EQ(on(HWY_AVX3), on(HWY_AVX2));
}

TEST(PhaseFunction, IllegalTablesSayWhatIsWrong) {
    expectMessages("phases", [](std::string_view text, std::string_view path) { parsePhase(text, path); });
}

}  // namespace
}  // namespace searchlight
