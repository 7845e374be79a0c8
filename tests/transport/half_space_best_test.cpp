// The low-variance walk against exact half-spaces and against the analogue walk.
#include <hwy/highway.h>

#include <numeric>

#include "exact.h"
#include "instruction_sets.h"
#include "transport/half_space/guided_walk.h"
#include "transport/half_space/importance.h"
#include "transport/half_space/single_scattering.h"

namespace searchlight {
namespace {

constexpr Estimator best = Estimator::best;

std::vector<double> uniformEdges(int bins, double width) {
    std::vector<double> edges;
    for (int i = 0; i <= bins; ++i) edges.push_back(i * width);
    return edges;
}

// Power: the totals rest on roulette and splitting, which aim at the bins; the standard errors are below 1 % in the
// middle of the range.
TEST(HalfSpaceBest, MatchedTotalsAgreeWithTheHFunctionAtSevenIncidences) {
    Judge judge;
    compareMatchedTotals(judge, 8e3, 51'000, best);
    judge.expectAgreement();
}

TEST(HalfSpaceBest, RefractiveTotalsAgreeWithAddingDoubling) {
    Judge judge;
    compareRefractiveTotals(judge, 6e3, 52'000, best);
    judge.expectAgreement();
}

// The standard errors are tenths of a percent up to several mean free paths.
TEST(HalfSpaceBest, AnnuliAgreeWithTheExactSearchlight) {
    Judge judge;
    compareSearchlight(judge, 1e6, 53'000, best);
    judge.expectAgreement();
}

// The total is known then; its standard error is that of one walk.
TEST(HalfSpaceBest, WithoutAbsorptionEverythingLeaves) {
    const Estimate matched = walk(ofAlbedo(1), 1e4, 54, {0, 10}, best).all.total;
    EXPECT_NEAR(matched.mean, 1, 1e-12);
    EXPECT_NEAR(matched.standard_error, 1e-4, 1e-9);
    const Estimate refractive = walk(ofAlbedo(1, 1.4, 0.5), 1e4, 55, {0, 10}, best).all.total;
    EXPECT_NEAR(refractive.mean, 1 - std::pow(0.4 / 2.4, 2), 1e-12);
    EXPECT_NEAR(refractive.standard_error, 1e-4 * refractive.mean, 1e-9);
}

// What guided walks find is then 1 on average, with weights from the roulette of long walks alone.
TEST(HalfSpaceBest, GuidedWalksWithoutAbsorptionAllLeave) {
    Judge judge;
    for (const double eta : {1.0, 1.4}) {
        BatchRatios sums(1);
        constexpr std::uint64_t walks = 200;
        for (std::uint64_t chunk = 0; chunk < 50; ++chunk) {
            const GuidedSums all = walkGuidedChunk(GuidedWalk({.absorbed = 0, .eta = eta}), 7, chunk, walks);
            sums.add({&all.total, 1}, static_cast<double>(walks));
        }
        judge.compare("guided", sums.estimate(0, 50 * walks), 1);
    }
    judge.expectAgreement();
}

struct Medium {
    const char* name;
    HalfSpaceProblem problem;
    double walks;
};

const Medium media[] = {
    {"marble", {.sigma_a = 0.0021, .sigma_s = 2.19, .eta = 1.5}, 3e5},
    {"skin1", {.sigma_a = 0.032, .sigma_s = 0.74, .eta = 1.3}, 1e6},
    {"skin1 at 60 deg", {.sigma_a = 0.032, .sigma_s = 0.74, .eta = 1.3, .angle_deg = 60}, 1e6},
    {"ketchup", {.sigma_a = 1.45, .sigma_s = 0.03, .eta = 1.3}, 5e6},
    {"forward", {.sigma_a = 0.05, .sigma_s = 2, .g = 0.65, .eta = 1.4, .angle_deg = 30}, 3e5},
    {"sharp", {.sigma_a = 0.01, .sigma_s = 10, .g = 0.9, .eta = 1.4}, 3e5},
    {"sharp, oblique", {.sigma_a = 0.1, .sigma_s = 4, .g = 0.8, .eta = 1.3, .angle_deg = 50}, 3e5},
    {"sharp, absorbing", {.sigma_a = 0.2, .sigma_s = 0.8, .g = 0.9, .eta = 1.3}, 1e6},
    {"backward", {.sigma_a = 0.05, .sigma_s = 0.95, .g = -0.4, .eta = 1.3}, 1e6},
    {"thinner", {.sigma_a = 0.05, .sigma_s = 0.95, .eta = 0.75, .angle_deg = 20}, 1e6},
    {"matched, oblique", {.sigma_a = 0.1, .sigma_s = 0.9, .g = 0.3, .eta = 1, .angle_deg = 75}, 1e6},
};

// The analogue walk, judged by itself elsewhere, supplies the larger error.
void compareWithAnalogue(Judge& judge, double scale, std::uint64_t seed) {
    for (const Medium& medium : media) {
        const HalfSpaceProblem& p = medium.problem;
        const std::vector<double> edges = uniformEdges(60, 0.1 / (p.sigma_a + (1 - p.g) * p.sigma_s));
        const HalfSpaceResult a = walk(p, scale * medium.walks, seed++, edges),
                              b = walk(p, scale * medium.walks, seed++, edges, best);
        ASSERT_EQ(b.estimator, best);
        const auto compare = [&](const char* what, Estimate x, Estimate y) {
            judge.compare(fmt::format("{}, {}", medium.name, what),
                          {y.mean, std::hypot(x.standard_error, y.standard_error), 0}, x.mean);
        };
        compare("total", a.all.total, b.all.total);
        compare("single", a.single.total, b.single.total);
        compare("mean x", a.all.mean_x_mm, b.all.mean_x_mm);
        compare("mean r2", a.all.mean_r2_mm2, b.all.mean_r2_mm2);
        compare("mean x of order 1", a.single.mean_x_mm, b.single.mean_x_mm);
        compare("mean r2 of order 1", a.single.mean_r2_mm2, b.single.mean_r2_mm2);
        for (std::size_t i = 0; i < a.all.Rd.size(); ++i) {
            const double exits = std::pow(a.all.Rd[i] / a.all.standard_error[i], 2);
            judge.compare(fmt::format("{}, bin {}", medium.name, i),
                          {b.all.Rd[i], std::hypot(a.all.standard_error[i], b.all.standard_error[i]), 0}, a.all.Rd[i],
                          exits);
            EXPECT_NEAR(b.single.Rd[i] + b.multiple.Rd[i], b.all.Rd[i], 1e-12 * b.all.Rd[i]);
        }
    }
}

TEST(HalfSpaceBest, AgreesWithTheAnalogueWalk) {
    Judge judge;
    compareWithAnalogue(judge, 0.3, 56'000);
    judge.expectAgreement();
}

// At equal walks; the factor is 25 or more in variance where it was measured, 4 leaves room for the noise of the
// errors.
TEST(HalfSpaceBest, HasSmallerStandardErrorsInTheBins) {
    for (const Medium& medium : {media[0], media[1], media[3]}) {
        const HalfSpaceProblem& p = medium.problem;
        const std::vector<double> edges = uniformEdges(20, 0.1 / (p.sigma_a + p.sigma_s));
        const HalfSpaceTally a = walk(p, 1e5, 57, edges).all, b = walk(p, 1e5, 57, edges, best).all;
        for (std::size_t i = 0; i < a.Rd.size(); ++i)
            EXPECT_LT(b.standard_error[i], 0.8 * a.standard_error[i]) << medium.name << ", bin " << i;
    }
}

// Every number, as one list: equal lists mean equal results, bit for bit.
std::vector<double> numbers(const HalfSpaceResult& result) {
    std::vector<double> all = {static_cast<double>(result.collisions)};
    for (const HalfSpaceTally* tally : {&result.all, &result.single, &result.multiple}) {
        for (const Estimate& e : {tally->total, tally->mean_x_mm, tally->mean_r2_mm2})
            all.insert(all.end(), {e.mean, e.standard_error});
        for (const auto* list : {&tally->Rd, &tally->standard_error, &tally->beyond})
            all.insert(all.end(), list->begin(), list->end());
    }
    return all;
}

HalfSpaceResult onTarget(std::int64_t target, const HalfSpaceProblem& problem, double walks, int threads = 1) {
    Observer observer;
    HalfSpaceOptions options;
    options.walks = static_cast<std::uint64_t>(walks);
    options.edges_mm = {0, 0.01, 0.1, 0.3, 1, 3, 10};
    options.estimator = best;
    options.threads = threads;
    hwy::SetSupportedTargetsForTest(target);
    const HalfSpaceResult result = walkHalfSpace(problem, options, observer);
    hwy::SetSupportedTargetsForTest(0);
    return result;
}

TEST(HalfSpaceBest, Avx2AndAvx512AgreeBitForBit) {
    if (!hasInstructionSet(HWY_AVX3)) GTEST_SKIP() << "no AVX-512 here";
    for (const Medium& medium : media)
        EXPECT_EQ(numbers(onTarget(HWY_AVX3, medium.problem, 5e4)), numbers(onTarget(HWY_AVX2, medium.problem, 5e4)))
            << medium.name;
}

TEST(HalfSpaceBest, ResultDoesNotDependOnThreads) {
    for (const Medium& medium : media)
        EXPECT_EQ(numbers(onTarget(0, medium.problem, 5e4, 1)), numbers(onTarget(0, medium.problem, 5e4, 2)))
            << medium.name;
}

TEST(HalfSpaceBest, TargetsWithoutFusedMultiplyAddAgreeStatistically) {
    Judge judge;
    std::uint64_t seed = 58;  // comparisons with one and the same result would not be independent
    for (const std::int64_t target : {HWY_SSE4, HWY_EMU128}) {
        if (target == HWY_SSE4 && !hasInstructionSet(HWY_SSE4)) continue;
        for (const Medium& medium : media) {
            const HalfSpaceTally a = walk(medium.problem, 1e5, seed++, {0, 0.01, 0.1, 0.3, 1, 3, 10}, best).all,
                                 b = onTarget(target, medium.problem, target == HWY_SSE4 ? 1e5 : 4e3).all;
            for (std::size_t i = 0; i < a.Rd.size(); ++i)
                judge.compare(medium.name, {b.Rd[i], std::hypot(a.standard_error[i], b.standard_error[i]), 0}, a.Rd[i]);
        }
    }
    judge.expectAgreement();
}

TEST(HalfSpaceBest, GridsAreWalkedByTheAnalogue) {
    Observer observer;
    HalfSpaceOptions options{.walks = 100, .edges_mm = {0, 1}, .grid = 4, .grid_extent_mm = 1, .estimator = best};
    EXPECT_EQ(walkHalfSpace({.sigma_a = 0.1}, options, observer).estimator, Estimator::analogue);
}

// A bin in which nothing can be foreseen to leave is no better known than by one exit.
TEST(HalfSpaceBest, EmptyBinHasTheStandardErrorOfOneExit) {
    const HalfSpaceResult r = walk({.sigma_a = 1, .sigma_s = 1}, 1000, 1, {0, 1000, 1001}, best);
    EXPECT_NEAR(r.multiple.standard_error[1] * std::numbers::pi * (1001. * 1001. - 1e6), 1e-3, 1e-12);
}

// After equally many collisions: guided walks hardly vary in weight, and have few of them.
TEST(HalfSpaceBest, HasSmallerStandardErrorsOfTheTotalAndTheMeanSquare) {
    for (const Medium& medium : media) {
        const HalfSpaceProblem& p = medium.problem;
        const std::vector<double> edges = uniformEdges(50, 0.1 / (p.sigma_a + (1 - p.g) * p.sigma_s));
        const HalfSpaceResult a = walk(p, 1e5, 59, edges), b = walk(p, 1e5, 59, edges, best);
        const double collisions = static_cast<double>(b.collisions) / static_cast<double>(a.collisions);
        const auto gain = [&](Estimate x, Estimate y) {
            return std::pow(x.standard_error / y.standard_error, 2) / collisions;
        };
        EXPECT_GT(gain(a.all.total, b.all.total), 1) << medium.name;
        EXPECT_GT(gain(a.all.mean_r2_mm2, b.all.mean_r2_mm2), 1) << medium.name;
    }
}

TEST(HalfSpaceBest, BinsAndBeyondMakeUpTheTotalWhereMuchLeavesBeyond) {
    const HalfSpaceTally all = walk(media[0].problem, 1e4, 60, {0.1, 1, 2}, best).all;
    const double within = std::numbers::pi * (0.99 * all.Rd[0] + 3 * all.Rd[1]);
    EXPECT_NEAR(within + all.beyond.at(0), all.total.mean, 1e-12);
}

TEST(SingleScattering, AgreesWithMidpointQuadrature) {
    // In mean free paths, as singleScattering is; exactSingle per unit incident flux. Its 2e5 points leave 1e-7.
    const std::vector<double> edges = {0, 0.002, 0.01, 0.1, 0.5, 1, 4};
    for (const double g : {0.0, 0.001, 0.5, 0.9, 0.99, -0.5, -0.9})
        for (const double eta : {1.0, 1.001, 1.3, 1.5, 0.8}) {
            const HalfSpaceProblem problem{.sigma_a = 0.5, .sigma_s = 0.5, .g = g, .eta = eta};
            const std::vector<double> exact = exactSingle(problem, edges);
            const SingleScattering single = singleScattering({.absorbed = 0.5, .g = g, .eta = eta}, edges);
            const double transmitted = 1 - std::pow((eta - 1) / (eta + 1), 2);
            for (std::size_t i = 0; i < exact.size(); ++i)
                EXPECT_NEAR(transmitted * single.flux[i + 1], exact[i], 2e-6 * exact[i])
                    << "g " << g << ", eta " << eta << ", annulus " << i;
            EXPECT_EQ(single.flux[0], 0);
            EXPECT_NEAR(std::accumulate(single.flux.begin(), single.flux.end(), 0.0), single.total,
                        1e-13 * single.total);
        }
}

// Isotropic, index matched: a/2 int mu / (1 + mu) dmu = a/2 (1 - log 2).
TEST(SingleScattering, TotalOfTheMatchedHalfSpaceIsClosed) {
    const std::vector<double> edges = {0.5, 1};
    const SingleScattering single = singleScattering({.absorbed = 0.2}, edges);
    EXPECT_NEAR(single.total, 0.4 * (1 - std::numbers::ln2), 1e-12);
    EXPECT_GT(single.flux[0], 0);
}

// m: cosine of the beam; a/2 int mu / (mu + m) dmu, and the mean shift of docs/oblique.md.
TEST(SingleScattering, TotalAndShiftOfTheMatchedHalfSpaceAreClosedAtAnyAngle) {
    const std::vector<double> edges = {0.5, 1};
    for (const double angle_deg : {1.0, 30.0, 60.0, 85.0}) {
        const double m = std::cos(angle_deg * std::numbers::pi / 180), s = std::sqrt(1 - m * m);
        const double log = std::log((1 + m) / m);
        const SingleScattering single = singleScattering({.absorbed = 0.2, .sin_beam = s, .cos_beam = m}, edges);
        EXPECT_NEAR(single.total, 0.4 * (1 - m * log), 1e-7 * single.total) << angle_deg;
        EXPECT_NEAR(single.x / single.total, s * (1 - 2 * m * log + m / (1 + m)) / (1 - m * log), 1e-6) << angle_deg;
    }
}

// Straight in the direction of the way out, where singleScattering() integrates over places. 800 x 400 midpoints leave
// some 1e-5.
TEST(SingleScattering, AgreesWithMidpointQuadratureOfDirectionsAtObliqueIncidence) {
    const std::vector<double> edges = {0, 0.1, 0.5, 1, 2, 4};
    for (const double g : {0.0, 0.6, 0.9, -0.5})
        for (const double eta : {1.0, 1.4, 0.8}) {
            const double s = 0.7, m = std::sqrt(1 - s * s), critical = eta > 1 ? std::sqrt(1 - 1 / (eta * eta)) : 0;
            std::vector<double> expected(edges.size() - 1);
            double x = 0, r2 = 0;
            constexpr int steps = 800, azimuths = 400;
            for (int i = 0; i < steps; ++i)
                for (int k = 0; k < azimuths; ++k) {
                    const double q = (i + 0.5) / steps, mu = critical + (1 - critical) * q * q;
                    const double sine = std::sqrt(1 - mu * mu),
                                 cosine = std::cos((k + 0.5) * std::numbers::pi / azimuths);
                    const double phase =
                        0.5 * (1 - g * g) / std::pow(1 + g * g - 2 * g * (s * sine * cosine - m * mu), 1.5);
                    const double out = std::sqrt(std::max(0.0, 1 - eta * eta * (1 - mu * mu)));
                    const double rs = (eta * mu - out) / (eta * mu + out), rp = (mu - eta * out) / (mu + eta * out);
                    const double rate = 1 + m / mu, shift = s + m * sine / mu * cosine;
                    const double place2 = 2 * s * shift - 1 + m * m / (mu * mu);
                    const double weight = 0.5 * phase * (1 - 0.5 * (rs * rs + rp * rp)) / rate * 2 * (1 - critical) *
                                          q / (steps * azimuths);
                    x += weight * shift / rate;
                    r2 += weight * 2 * place2 / (rate * rate);
                    for (std::size_t bin = 0; bin + 1 < edges.size(); ++bin)
                        expected[bin] += weight * (std::exp(-edges[bin] * rate / std::sqrt(place2)) -
                                                   std::exp(-edges[bin + 1] * rate / std::sqrt(place2)));
                }
            const SingleScattering single =
                singleScattering({.absorbed = 0.5, .g = g, .eta = eta, .sin_beam = s, .cos_beam = m}, edges);
            for (std::size_t bin = 0; bin < expected.size(); ++bin)
                EXPECT_NEAR(single.flux[bin + 1], expected[bin], 1e-4 * expected[bin])
                    << "g " << g << ", eta " << eta << ", annulus " << bin;
            EXPECT_NEAR(single.x, x, 1e-4 * std::abs(x) + 1e-6);
            EXPECT_NEAR(single.r2, r2, 1e-4 * r2);
        }
}

TEST(ImportanceTable, IsPositiveBoundedAndFallsWithDepth) {
    const std::vector<double> edges = {0, 5};
    constexpr auto n = static_cast<std::size_t>(ImportanceTable::kCells);
    for (const HalfSpaceWalk& walk : {HalfSpaceWalk{.absorbed = 0}, HalfSpaceWalk{.absorbed = 1 - 1e-9},
                                      HalfSpaceWalk{.absorbed = 0.01, .g = -0.9}}) {
        const ImportanceTable table = makeImportanceTable(walk, edges, tuningFor(walk));
        ASSERT_EQ(table.value.size(), n * n);
        for (const float value : table.value) EXPECT_TRUE(value > 0 && value <= 1e3f) << value;
        for (std::size_t row = n / 2; row + 1 < n; ++row) EXPECT_LE(table.value[(row + 1) * n], table.value[row * n]);
    }
}

}  // namespace
}  // namespace searchlight
