// physics/erfcx.glsl, through its double-precision twin.
#include <cmath>
#include <numbers>

#include "model/physics.h"

namespace searchlight {
namespace {

// The defect by its continued fraction, backwards: sqrt(pi) erfcx(x) = 1 / (x + (1/2) / (x + (2/2) / (x + ...))),
// [Abramowitz1964] 7.1.14, so that 1 - sqrt(pi) x erfcx(x) = tail / (x + tail). In long double, for x >= 0.3.
long double defectByFraction(long double x) {
    long double tail = 0;
    for (int k = 200'000; k >= 1; --k) tail = 0.5L * static_cast<long double>(k) / (x + tail);
    return tail / (x + tail);
}

TEST(Erfcx, IsTheProductWhereThatCanBeFormed) {
    for (const double x : {0.0, 1e-8, 1e-3, 0.1, 0.5, 1.0, 2.0, 5.0}) {
        const long double exact = std::exp(static_cast<long double>(x) * x) * std::erfc(static_cast<long double>(x));
        EXPECT_NEAR(Physics<double>::erfcxAndDefect(x)[0] / static_cast<double>(exact), 1, 2e-15) << x;
    }
}

// 6.28 and 6.29 are on either side of the seam at pi / h; at 1e6 the defect is 5e-13.
TEST(Erfcx, FallsShortOfItsAsymptoteByTheContinuedFraction) {
    for (const double x : {0.3, 1.0, 3.0, 6.28, 6.29, 10.0, 100.0, 1e3, 1e6}) {
        const auto defect = static_cast<double>(defectByFraction(x));
        EXPECT_NEAR(Physics<double>::erfcxAndDefect(x)[1] / defect, 1, 1e-14) << x;
        // Float: the terms are positive; the residue has an exponent of at most 39.
        EXPECT_NEAR(Physics<float>::erfcxAndDefect(static_cast<float>(x))[1] / defect, 1, 1e-6) << x;
    }
}

TEST(Erfcx, DefectStartsAtOne) {
    EXPECT_EQ(Physics<double>::erfcxAndDefect(0)[0], 1);
    EXPECT_NEAR(Physics<double>::erfcxAndDefect(0)[1], 1, 1e-15);
    EXPECT_NEAR(Physics<double>::erfcxAndDefect(1e-6)[1], 1 - std::sqrt(std::numbers::pi) * 1e-6, 1e-11);
}

}  // namespace
}  // namespace searchlight
