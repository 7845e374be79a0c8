#include "validate/curve_error.h"

#include <cmath>
#include <numbers>

namespace searchlight {
namespace {

using ::testing::DoubleNear;

std::vector<Rgb> gray(const std::vector<double>& values) {
    std::vector<Rgb> list;
    for (const double v : values) list.push_back({v, v, v});
    return list;
}

// Sums of three products; double keeps 15 digits of them.
constexpr double rounding = 1e-14;

TEST(CurveError, IsZeroForAPerfectModel) {
    const auto reference = gray({3, 2, 1});
    const CurveError error = curveError(reference, reference, gray({0, 0, 0}), std::vector<double>{0, 1, 2, 4}, 0, 1);
    EXPECT_EQ(error.weighted, 0);
    EXPECT_EQ(error.relative_rms, 0);
    EXPECT_EQ(error.noise, 0);
}

TEST(CurveError, WeighsAnnuliByTheirArea) {
    // Areas over pi: 1 and 3. Only the outer ring is wrong, by 0.5.
    const CurveError error = curveError(gray({2, 1.5}), gray({2, 1}), gray({0, 0}), std::vector<double>{0, 1, 2}, 0, 1);
    EXPECT_THAT(error.weighted, DoubleNear(0.5 * 3 / (2 * 1 + 1 * 3), rounding));
    EXPECT_EQ(error.near, 0);
    EXPECT_THAT(error.far, DoubleNear(0.5, rounding));
    EXPECT_THAT(error.relative_rms, DoubleNear(0.5 / std::numbers::sqrt2, rounding));
}

TEST(CurveError, OverestimatesAndUnderestimatesDoNotCancel) {
    const CurveError error =
        curveError(gray({2, 0}), gray({1, 1}), gray({0, 0}), std::vector<double>{0, 1, std::numbers::sqrt2}, 0, 10);
    EXPECT_THAT(error.weighted, DoubleNear(1, rounding));
}

TEST(CurveError, RelativeErrorLeavesOutNoisyAnnuli) {
    // The second annulus is known to 10 % only.
    const CurveError error =
        curveError(gray({1.2, 9}), gray({1, 1}), gray({0.01, 0.1}), std::vector<double>{0, 1, 2}, 0, 10);
    EXPECT_THAT(error.relative_rms, DoubleNear(0.2, rounding));
}

TEST(CurveError, NoiseIsTheMeanAbsoluteDeviationOfTheReference) {
    const CurveError error = curveError(gray({1}), gray({1}), gray({0.1}), std::vector<double>{0, 1}, 0, 10);
    EXPECT_THAT(error.noise, DoubleNear(0.1 * std::sqrt(2 / std::numbers::pi), rounding));
}

TEST(CurveError, ReadsTheChannelAskedFor) {
    const std::vector<Rgb> model{{1, 2, 3}}, reference{{1, 1, 1}};
    const std::vector<double> edges{0, 1};
    EXPECT_EQ(curveError(model, reference, gray({0}), edges, 0, 1).weighted, 0);
    EXPECT_THAT(curveError(model, reference, gray({0}), edges, 2, 1).weighted, DoubleNear(2, rounding));
}

}  // namespace
}  // namespace searchlight
