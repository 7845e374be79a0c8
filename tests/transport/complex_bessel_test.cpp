#include "transport/half_space/complex_bessel.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace searchlight {
namespace {

using Complex = std::complex<double>;

// [Abramowitz1964] 9.6.24, far finer than the function itself samples it, scaled by exp(z).
BesselK byIntegral(Complex z) {
    constexpr double step = 0.01;
    BesselK sum{0.5 * step, 0.5 * step};
    for (int i = 1; i * step < 30; ++i) {
        const double cosh = std::cosh(i * step);
        if (z.real() * (cosh - 1) > 50) break;
        const Complex term = step * std::exp(-z * (cosh - 1));
        sum.K0 += term;
        sum.K1 += term * cosh;
    }
    return sum;
}

TEST(BesselK, AgreesWithItsIntegralInEveryRegime) {
    double worst = 0;
    for (double size = 1e-3; size < 100; size *= 1.1)
        for (const double turn : {-0.25, -0.1, 0.0, 0.2}) {
            const Complex z = std::polar(size, turn * std::numbers::pi);
            const BesselK exact = byIntegral(z), K = besselK(z);
            const Complex scale = std::exp(-z);
            worst =
                std::max({worst, std::abs(K.K0 / (scale * exact.K0) - 1.0), std::abs(K.K1 / (scale * exact.K1) - 1.0)});
        }
    // Rounding of exp(-z) at |z| = 100 is 1e-14; the ascending series loses a digit at its end.
    EXPECT_LT(worst, 5e-14);
}

TEST(BesselK, AgreesWithTheStandardLibraryOnTheRealAxis) {
    for (const double x : {0.01, 1.0, 1.99, 2.01, 17.9, 18.1, 60.0}) {
        EXPECT_NEAR(besselK(x).K0.real() / std::cyl_bessel_k(0, x), 1, 1e-13) << x;
        EXPECT_NEAR(besselK(x).K1.real() / std::cyl_bessel_k(1, x), 1, 1e-13) << x;
    }
}

}  // namespace
}  // namespace searchlight
