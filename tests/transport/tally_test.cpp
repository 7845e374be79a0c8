#include "transport/walk/tally.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "transport/walk/long_walk.h"
#include "transport/walk/radial_edges.h"

namespace searchlight {
namespace {

std::size_t searched(const std::vector<double>& edges, double r2) {
    std::size_t slot = 0;
    while (slot < edges.size() && r2 >= edges[slot] * edges[slot]) ++slot;
    return slot;
}

TEST(RadialBins, AgreeWithLinearSearchOnAndAroundEveryEdge) {
    const std::vector<std::vector<double>> cases = {{0, 1},
                                                    {0.5, 0.6},
                                                    {0, 1e-9, 1, 1e9},
                                                    linearEdges(1000, 20),
                                                    linearEdges(5000, 1e-3),
                                                    {0, 1, 1 + 1e-12, 1 + 2e-12, 2},
                                                    defaultEdges({.sigma_a = 0.01, .sigma_s = 1}, 100)};
    std::mt19937_64 random(1);
    for (const std::vector<double>& edges : cases) {
        const RadialBins bins(edges);
        EXPECT_EQ(bins.slots(), edges.size() + 1);
        const auto expectFound = [&](double r2) { EXPECT_EQ(bins.slot(r2), searched(edges, r2)) << r2; };
        for (const double edge : edges) {
            const double r2 = edge * edge;
            expectFound(r2);
            expectFound(std::nextafter(r2, std::numeric_limits<double>::infinity()));
            if (r2 > 0) expectFound(std::nextafter(r2, 0.0));
        }
        std::uniform_real_distribution<double> radius(0, 1.1 * edges.back());
        for (int i = 0; i < 10'000; ++i) expectFound(std::pow(radius(random), 2));
        expectFound(0);
        expectFound(1e300);
    }
}

TEST(ExitTally, SplitsByOrderAndWeighsLongWalks) {
    const std::vector<double> edges = {0, 1, 2};
    const TallyLayout layout{RadialBins(edges), 2, 1.0};
    ExitTally tally(layout);
    const std::vector<float> x = {0.5f, -0.5f, 0, 3}, y = {0, -0.5f, 1.5f, 0};
    const std::vector<std::int32_t> collisions = {1, 2, 4 * kLongWalk, 1};
    tally.add(x, y, collisions);
    const ExitTally::Sums &single = tally.sums(ExitTally::single), &multiple = tally.sums(ExitTally::multiple);
    // total, below, two bins, beyond, then the cells (-,-) (+,-) (-,+) (+,+).
    EXPECT_EQ(single.flux, (std::vector<double>{2, 0, 1, 0, 1, 0, 0, 0, 1}));
    EXPECT_EQ(multiple.flux, (std::vector<double>{5, 0, 1, 4, 0, 1, 0, 0, 0}));
    EXPECT_EQ(single.x, 3.5);
    EXPECT_EQ(single.r2, 9.25);
    EXPECT_EQ(multiple.x, -0.5);
    EXPECT_EQ(multiple.r2, 0.5 + 4 * 2.25);
}

TEST(BatchRatios, AreTheEstimateOfTheBatches) {
    const std::vector<double> sums = {3, 5, 2, 7, 6};
    const std::vector<std::uint64_t> counts = {10, 12, 9, 15, 11};
    BatchRatios ratios(1);
    for (std::size_t b = 0; b < sums.size(); ++b) ratios.add({&sums[b], 1}, static_cast<double>(counts[b]));
    const Estimate a = ratios.estimate(0, 57), b = estimateFromBatches(sums, counts);
    EXPECT_DOUBLE_EQ(a.mean, b.mean);
    EXPECT_NEAR(a.standard_error, b.standard_error, 1e-14);  // differences of squares of order 1e2
    EXPECT_EQ(a.count, 57u);
}

TEST(BatchRatios, KnowNothingFromOneBatchOrFromNone) {
    BatchRatios ratios(1);
    EXPECT_EQ(ratios.estimate(0, 0).standard_error, std::numeric_limits<double>::infinity());
    const double sum = 1;
    ratios.add({&sum, 1}, 2);
    EXPECT_EQ(ratios.estimate(0, 2).mean, 0.5);
    EXPECT_EQ(ratios.estimate(0, 2).standard_error, std::numeric_limits<double>::infinity());
}

// Unbiased means: at every n, the chance to survive n collisions times the weight is 1.
TEST(LongWalk, SurvivalTimesWeightIsOne) {
    SplitMix64 random(3);
    constexpr int draws = 2'000'000;
    const std::vector<std::int32_t> lengths = {kLongWalk,    kLongWalk + 1,    3 * kLongWalk,   100 * kLongWalk,
                                               kEndlessWalk, kEndlessWalk + 1, kEndlessWalk + 2};
    std::vector<int> survived(lengths.size(), 0);
    for (int i = 0; i < draws; ++i) {
        const std::int32_t end = longWalkSurvives(random);
        for (std::size_t k = 0; k < lengths.size(); ++k) survived[k] += end >= lengths[k];
    }
    for (std::size_t k = 0; k < lengths.size(); ++k) {
        const double weight = longWalkWeight(lengths[k]), chance = static_cast<double>(survived[k]) / draws;
        EXPECT_NEAR(chance, 1 / weight, 5 * std::sqrt(1 / weight * (1 - 1 / weight) / draws)) << lengths[k];
    }
    EXPECT_EQ(longWalkWeight(kLongWalk), 1);
}

TEST(RadialEdges, CoverWhatLeaves) {
    for (const HalfSpaceProblem& problem : {HalfSpaceProblem{.sigma_a = 0.0021, .sigma_s = 2.19, .eta = 1.5},
                                            HalfSpaceProblem{.sigma_a = 1.45, .sigma_s = 0.03, .eta = 1.3},
                                            HalfSpaceProblem{.sigma_a = 0.01, .sigma_s = 10, .g = 0.9, .eta = 1.4}}) {
        Observer observer;
        HalfSpaceOptions options;
        options.walks = 100'000;
        options.edges_mm = defaultEdges(problem);
        ASSERT_EQ(options.edges_mm.size(), 51u);
        EXPECT_EQ(options.edges_mm.front(), 0);
        const HalfSpaceResult result = walkHalfSpace(problem, options, observer);
        // A factor of 10 about the 0.1 % that a matched dipole promises.
        EXPECT_LT(result.all.beyond.at(0), 0.01 * result.all.total.mean);
    }
    EXPECT_EQ(linearEdges(4, 2), (std::vector<double>{0, 0.5, 1, 1.5, 2}));
}

}  // namespace
}  // namespace searchlight
