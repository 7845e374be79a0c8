// The low-variance walk, long: small errors, and honest ones.
#include "exact.h"

namespace searchlight {
namespace {

constexpr Estimator best = Estimator::best;

TEST(HalfSpaceBestLong, MatchedTotalsAgreeWithTheHFunctionAtSevenIncidences) {
    Judge judge;
    compareMatchedTotals(judge, 5e5, 150'000, best);
    judge.expectAgreement();
}

TEST(HalfSpaceBestLong, RefractiveTotalsAgreeWithAddingDoubling) {
    Judge judge;
    compareRefractiveTotals(judge, 1e6, 250'000, best);
    judge.expectAgreement();
}

// The median standard error is 0.02 %.
TEST(HalfSpaceBestLong, AnnuliAgreeWithTheExactSearchlight) {
    Judge judge;
    compareSearchlight(judge, 3e7, 350'000, best);
    judge.expectAgreement();
}

struct Spread {
    double sum = 0, square = 0, variance = 0;
    int count = 0;

    void add(double value, double error) { sum += value, square += value * value, variance += error * error, ++count; }
    double ratio() const { return std::sqrt((square - sum * sum / count) / (count - 1) / (variance / count)); }
};

// A walk deposits many times; only the scatter of whole chunks knows what that means. 1,000 repetitions know a spread
// within 2.2 % where errors are nearly normal; 0.1 is 4.5 times that.
TEST(HalfSpaceBestLong, StandardErrorsAreTheSpreadOverSeeds) {
    const std::vector<double> edges = {0, 0.2, 0.5, 1, 2, 4};
    for (const HalfSpaceProblem& problem :
         {HalfSpaceProblem{.sigma_a = 0.1, .sigma_s = 0.9, .eta = 1.3, .angle_deg = 45},
          HalfSpaceProblem{.sigma_a = 0.01, .sigma_s = 0.99, .g = 0.3, .eta = 1.5},
          HalfSpaceProblem{.sigma_a = 0.02, .sigma_s = 5, .g = 0.8, .eta = 1.4}}) {
        Spread total, x, r2, bins[5];
        for (std::uint64_t seed = 0; seed < 1000; ++seed) {
            const HalfSpaceTally all = walk(problem, 8192, seed, edges, best).all;
            total.add(all.total.mean, all.total.standard_error);
            x.add(all.mean_x_mm.mean, all.mean_x_mm.standard_error);
            r2.add(all.mean_r2_mm2.mean, all.mean_r2_mm2.standard_error);
            for (std::size_t i = 0; i < 5; ++i) bins[i].add(all.Rd[i], all.standard_error[i]);
        }
        EXPECT_NEAR(total.ratio(), 1, 0.1);
        EXPECT_NEAR(x.ratio(), 1, 0.1);
        EXPECT_NEAR(r2.ratio(), 1, 0.1);
        for (const Spread& bin : bins) EXPECT_NEAR(bin.ratio(), 1, 0.1);
    }
}

}  // namespace
}  // namespace searchlight
