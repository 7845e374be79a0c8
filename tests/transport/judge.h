// Many comparisons with the truth, judged together.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "base/estimate.h"

namespace searchlight {

/// Upper tail of the standard normal distribution.
inline double normalTail(double z) { return 0.5 * std::erfc(z / std::sqrt(2.0)); }

/// The z that a standard normal number exceeds with probability p < 1/2.
inline double normalQuantile(double p) {
    double low = 0, high = 40;
    for (int i = 0; i < 80; ++i) (normalTail(0.5 * (low + high)) > p ? low : high) = 0.5 * (low + high);
    return low;
}

/// Collects z = (estimate - truth) / standard error. A family of N passes when every |z| stays under
/// Phi^-1(1 - .0005 / N) and the sum of their squares under the upper 1e-4 quantile of chi^2. Bins that expect fewer
/// than 50 exits are far from normal: they must stay under 8 and count for nothing else.
class Judge {
public:
    void compare(const std::string& what, Estimate estimate, double truth, double expected_exits = 1e9) {
        const double z = (estimate.mean - truth) / estimate.standard_error;
        if (expected_exits < 50) {
            EXPECT_LT(std::abs(z), 8) << what << ": " << estimate.mean << " against " << truth;
            return;
        }
        if (std::abs(z) >= std::abs(worst_)) worst_ = z, worst_what_ = what;
        chi2_ += z * z;
        z_sum_ += z;
        ++count_;
        if (truth != 0) relative_errors_.push_back(estimate.standard_error / std::abs(truth));
    }

    void expectAgreement() {
        ASSERT_GT(count_, 0);
        const double n = count_;
        EXPECT_LT(std::abs(worst_), normalQuantile(0.0005 / n)) << "worst of " << n << ": " << worst_what_;
        // Wilson and Hilferty: (chi^2 / n)^(1/3) is nearly normal.
        const double h = 2 / (9 * n);
        EXPECT_LT((std::cbrt(chi2_ / n) - (1 - h)) / std::sqrt(h), normalQuantile(1e-4)) << "chi^2 / N " << chi2_ / n;
        EXPECT_LT(std::abs(z_sum_) / std::sqrt(n), normalQuantile(0.00005)) << "a shift common to all";
        recordProperties();
    }

private:
    // The power of the family: what it would have seen.
    void recordProperties() {
        std::sort(relative_errors_.begin(), relative_errors_.end());
        testing::Test::RecordProperty("comparisons", count_);
        testing::Test::RecordProperty("chi2_per_comparison", std::to_string(chi2_ / count_));
        testing::Test::RecordProperty("worst_z", std::to_string(worst_));
        const double median = relative_errors_.empty() ? 0 : relative_errors_[relative_errors_.size() / 2];
        testing::Test::RecordProperty("median_relative_standard_error", std::to_string(median));
    }

    int count_ = 0;
    double chi2_ = 0, z_sum_ = 0, worst_ = 0;
    std::string worst_what_;
    std::vector<double> relative_errors_;
};

}  // namespace searchlight
