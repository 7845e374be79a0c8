#include "transport/exact/complex_bessel.h"

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
        for (const double turn : {-0.45, -0.4, -0.3, -0.25, -0.1, 0.0, 0.2}) {
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

// [Abramowitz1964] 9.6.4: K0(-ix) = (i pi / 2) (J0 + i Y0), K1(-ix) = -(pi / 2) (J1 + i Y1).
TEST(BesselK, IsAHankelFunctionOnTheImaginaryAxis) {
    for (const double x : {0.01, 1.0, 1.99, 2.01, 5.0, 17.9, 18.1, 60.0}) {
        const BesselK K = besselK(Complex(1e-14, -x));
        const Complex H0(std::cyl_bessel_j(0, x), std::cyl_neumann(0, x));
        const Complex H1(std::cyl_bessel_j(1, x), std::cyl_neumann(1, x));
        const double half_pi = 0.5 * std::numbers::pi;
        EXPECT_LT(std::abs(K.K0 / (Complex(0, half_pi) * H0) - 1.0), 1e-12) << x;
        EXPECT_LT(std::abs(K.K1 / (-half_pi * H1) - 1.0), 1e-12) << x;
    }
}

}  // namespace
}  // namespace searchlight
