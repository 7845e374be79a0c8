#include "white_families.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hwy/highway.h>

#include <cmath>

#include "base/error.h"
#include "instruction_sets.h"
#include "transport/white/white_file.h"
#include "transport/white/white_roulette.h"
#include "transport/white/white_walk.h"

namespace searchlight {
namespace {

using testing::HasSubstr;

// Standard errors: 0.05 % to 2 % of the totals.
TEST(White, TotalsOfAllAlbedosFromOneTableAgreeWithTheHFunction) { compareWhiteTotals(2e5, 11); }

TEST(White, AnnuliAgreeWithTheExactSearchlight) { compareWhiteSearchlight(5e5, 12); }

TEST(White, CurvesAgreeWithTheAnalogueWalk) { compareWhiteWithWalk(5e4, 13); }

// The same walks weighed one by one are the truth here; what cells add must be lost in the statistical error. It is
// 0.023 of that of 1e5 walks, and 0.06 or 0.09 without the second or the first moment of a cell. Albedos and radii are
// such that bins end where cells do, in both views: powers of 2^(1/24), or so near 1 that it does not matter.
TEST(White, CellsAddAFewPercentOfTheStandardErrorAtMost) {
    constexpr std::uint64_t chunks = 6, walks = chunks * 16'384;  // the smallest chunks of a job
    Observer observer;
    const WhiteTable white = buildWhiteTable({.eta = 1.3, .walks = walks, .seed = 5}, 0, observer);
    std::vector<double> edges = {0};
    for (int octave = -3; octave <= 4; ++octave) edges.push_back(std::exp2(octave));
    std::vector<WhiteExits> exits(chunks);
    for (std::uint64_t i = 0; i < chunks; ++i)
        walkWhiteChunk({0, 1.3, 0, 1, kWhiteRoulette}, 5, i, walks / chunks, exits[i]);
    int by_path = 0, by_collisions = 0;
    double largest = 0;
    for (const double albedo : {std::exp2(-135 / 24.0), 0.5, std::exp2(-6 / 24.0), std::exp2(-2 / 24.0),
                                std::exp2(-1 / 24.0), 0.999, 0.9999}) {
        std::vector<double> path(edges.size()), collisions(edges.size());
        const auto bin = [&](double r) {  // the last one is beyond the edges
            return static_cast<std::size_t>(std::upper_bound(edges.begin(), edges.end(), r) - edges.begin()) - 1;
        };
        for (const WhiteExits& chunk : exits)
            for (std::size_t i = 0; i < chunk.count; ++i) {
                const double r = std::hypot(double{chunk.x[i]}, double{chunk.y[i]});
                const double n = chunk.collisions[i], weight = std::exp(kWhiteRoulette * n);
                path[bin(r / albedo)] += weight * std::exp(-(1 - albedo) / albedo * chunk.length[i]);
                collisions[bin(r)] += weight * std::pow(albedo, n);
            }
        const HalfSpaceResult result = evaluateWhite(white, 1 - albedo, albedo, edges);
        for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
            const double area = std::numbers::pi * (edges[i + 1] - edges[i]) * (edges[i + 1] + edges[i]);
            const auto error = [&](const std::vector<double>& sums) {
                const double truth = (1 - result.specular) * sums[i] / (area * walks);
                return std::abs(result.all.Rd[i] - truth) / result.all.standard_error[i];
            };
            // The pilot decides which of the views was taken; the other is off by a good part of a standard error.
            EXPECT_LT(std::min(error(path), error(collisions)), 0.04) << "albedo " << albedo << ", bin " << i;
            ++(error(path) < error(collisions) ? by_path : by_collisions);
            largest = std::max(largest, std::min(error(path), error(collisions)));
        }
    }
    RecordProperty("largest_error_in_standard_errors", std::to_string(largest));
    EXPECT_GE(by_path, 5);
    EXPECT_GE(by_collisions, 5);
}

// Ketchup, blue: at 5 mean free paths an unabsorbed path weighs exp(-48 * 5).
TEST(White, FarOutAtLowAlbedoCollisionsAreTheView) {
    const WhiteTable white = whiteTable({.eta = 1.3}, 2e5, 21);
    const HalfSpaceProblem ketchup{.sigma_a = 1.45, .sigma_s = 0.03, .eta = 1.3};
    const double mfp = 1 / 1.48;
    const HalfSpaceTally all =
        evaluateWhite(white, ketchup.sigma_a, ketchup.sigma_s, std::vector<double>{4.9 * mfp, 5.4 * mfp}).all;
    EXPECT_LT(all.standard_error[0], 0.5 * all.Rd[0]);
    EXPECT_GT(all.Rd[0], 0);
}

TEST(White, TableDoesNotDependOnThreadsButOnItsSeed) {
    Observer observer;
    const WhiteKey key{.g = 0.5, .eta = 1.4, .angle_deg = 30, .walks = 20'000, .seed = 3};
    const auto bytes = [&](WhiteKey k, int threads) {
        WhiteTable white = buildWhiteTable(k, threads, observer);
        white.build_seconds = 0;
        return whiteTableBytes(white);
    };
    const std::string one = bytes(key, 1);
    EXPECT_EQ(one, bytes(key, 2));
    WhiteKey other = key;
    other.seed = 4;
    EXPECT_NE(one, bytes(other, 1));
    if (!hasInstructionSet(HWY_AVX3)) GTEST_SKIP() << "no AVX-512 here";
    hwy::SetSupportedTargetsForTest(HWY_AVX2);
    EXPECT_STREQ(whiteInstructionSet(), "AVX2");
    EXPECT_EQ(one, bytes(key, 1));
    hwy::SetSupportedTargetsForTest(0);
}

TEST(White, MediaBeyondATableAreRefusedByName) {
    Observer observer;
    const WhiteTable white = buildWhiteTable({.walks = 1000}, 0, observer);
    const std::vector<double> edges = {0, 1};
    const auto message = [&](double sigma_a, double sigma_s, std::vector<double> at) -> std::string {
        try {
            evaluateWhite(white, sigma_a, sigma_s, at);
        } catch (const Error& error) {
            return error.what();
        }
        return "accepted";
    };
    EXPECT_EQ(message(1.0002e-4, 1, edges), "accepted");
    EXPECT_THAT(message(0.9e-4, 1, edges), HasSubstr("too near 1"));
    EXPECT_THAT(message(0, 1, edges), HasSubstr("too near 1"));
    EXPECT_THAT(message(1, 1, {0, 600}), HasSubstr("ends at 512 mm"));
    EXPECT_THAT(message(-1, 1, edges), HasSubstr("a coefficient"));
    EXPECT_THAT(message(1, 1, {0, 0}), HasSubstr("ascend"));
    EXPECT_EQ(message(1, 0, edges), "accepted");
    EXPECT_THROW(buildWhiteTable({.g = 1}, 0, observer), Error);
    EXPECT_THROW(buildWhiteTable({.eta = std::nan("")}, 0, observer), Error);
    EXPECT_THROW(buildWhiteTable({.walks = 0}, 0, observer), Error);
}

TEST(White, BuildingCanBeCancelledAndReportsItsProgress) {
    struct Impatient : Observer {
        std::atomic<std::uint64_t> last = 0, total = 0;
        std::uint64_t patience = 0;
        void progress(std::string_view, std::uint64_t done, std::uint64_t of, std::string_view) override {
            last = done, total = of;
        }
        bool cancelled() const override { return last > patience; }
    } observer;
    EXPECT_THROW(buildWhiteTable({.walks = 100'000}, 1, observer), Error);
    observer.patience = 1'000'000;
    buildWhiteTable({.walks = 800}, 1, observer);
    EXPECT_EQ(observer.last, 900u);
    EXPECT_EQ(observer.total, 900u);
}

// A beam that never enters a thinner medium, and a medium that does not scatter.
TEST(White, WhereNothingEntersNothingLeaves) {
    Observer observer;
    const WhiteTable white = buildWhiteTable({.eta = 0.5, .angle_deg = 60, .walks = 1000}, 0, observer);
    const HalfSpaceResult result = evaluateWhite(white, 1, 1, std::vector<double>{0, 1});
    EXPECT_EQ(result.specular, 1);
    EXPECT_EQ(result.all.total.mean, 0);
    EXPECT_EQ(result.all.Rd, std::vector<double>{0});
}

}  // namespace
}  // namespace searchlight
