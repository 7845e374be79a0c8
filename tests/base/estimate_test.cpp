#include "base/estimate.h"

#include <cmath>
#include <random>

namespace searchlight {
namespace {

TEST(Estimate, EqualBatchesGiveTheStandardErrorOfTheirMeans) {
    const std::vector<double> sums{10, 12, 11, 15};
    const std::vector<std::uint64_t> counts{10, 10, 10, 10};
    const Estimate estimate = estimateFromBatches(sums, counts);
    EXPECT_DOUBLE_EQ(estimate.mean, 1.2);
    EXPECT_EQ(estimate.count, 40u);
    // Means 1, 1.2, 1.1, 1.5: variance (0.04 + 0 + 0.01 + 0.09) / 3, of the mean a quarter of it.
    EXPECT_NEAR(estimate.standard_error, std::sqrt(0.14 / 3 / 4), 1e-15);
}

TEST(Estimate, OneBatchKnowsNothingOfItsError) {
    const Estimate estimate = estimateFromBatches(std::vector<double>{5}, std::vector<std::uint64_t>{10});
    EXPECT_EQ(estimate.mean, 0.5);
    EXPECT_TRUE(std::isinf(estimate.standard_error));
    EXPECT_EQ(estimateFromBatches({}, {}).count, 0u);
}

// Batches of unequal size: the stated error is the spread that repetition shows.
TEST(Estimate, StandardErrorOfUnequalBatchesIsThatOfRepetition) {
    std::mt19937_64 random(7);
    std::exponential_distribution<double> sample(1);
    constexpr int repetitions = 2000, batches = 64;
    double sum = 0, sum_squares = 0, stated = 0;
    for (int repetition = 0; repetition < repetitions; ++repetition) {
        std::vector<double> sums(batches, 0);
        std::vector<std::uint64_t> counts;
        for (int b = 0; b < batches; ++b) {
            counts.push_back(4 + static_cast<std::uint64_t>(b % 5));
            for (std::uint64_t i = 0; i < counts.back(); ++i) sums[static_cast<std::size_t>(b)] += sample(random);
        }
        const Estimate estimate = estimateFromBatches(sums, counts);
        sum += estimate.mean;
        sum_squares += estimate.mean * estimate.mean;
        stated += estimate.standard_error / repetitions;
    }
    const double mean = sum / repetitions;
    const double spread = std::sqrt((sum_squares / repetitions - mean * mean) * repetitions / (repetitions - 1));
    // The spread of 2,000 repetitions is known to 1 / sqrt(4,000) = 1.6 %; five standard errors.
    EXPECT_NEAR(stated / spread, 1, 5 * 0.016);
}

}  // namespace
}  // namespace searchlight
