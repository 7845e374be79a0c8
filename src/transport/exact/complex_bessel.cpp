#include "transport/exact/complex_bessel.h"

#include <array>
#include <cmath>
#include <numbers>

namespace searchlight {

namespace {

using Complex = std::complex<double>;

// [Abramowitz1964] 9.6.13 and 9.6.11 with n = 1. 16 terms leave 1 / (15! 16!) at |z| = 2.
BesselK ascendingSeries(Complex z) {
    const Complex log_half = std::log(0.5 * z) + std::numbers::egamma, square = 0.25 * z * z;
    Complex term = 1, K0 = 0, K1 = 0;  // term: (z/2)^(2n) / n!^2
    double harmonic = 0;               // 1 + 1/2 + ... + 1/n
    for (int n = 0; n < 16; ++n) {
        K0 += term * (harmonic - log_half);
        K1 += term / (n + 1.0) * (log_half - harmonic - 0.5 / (n + 1));
        harmonic += 1.0 / (n + 1);
        term *= square / ((n + 1.0) * (n + 1.0));
    }
    return {K0, 1.0 / z + 0.5 * z * K1};
}

// [Abramowitz1964] 9.6.24 by the trapezoidal rule: exp(-2 pi (pi/4) / step) remains of an integral whose size on the
// line pi/4 above the real one is 1, and K is no smaller than exp(-13) here, so 1e-20 relative.
BesselK integral(Complex z) {
    constexpr double step = 1.0 / 12;
    static const std::array<double, 54> cosh = [] {
        std::array<double, 54> table;
        for (std::size_t i = 0; i < table.size(); ++i) table[i] = std::cosh(step * static_cast<double>(i));
        return table;
    }();
    Complex K0 = 0.5 * std::exp(-z), K1 = K0;
    for (std::size_t i = 1; i < cosh.size() && z.real() * (cosh[i] - 1) < 40; ++i) {
        const Complex term = std::exp(-z * cosh[i]);
        K0 += term;
        K1 += term * cosh[i];
    }
    return {step * K0, step * K1};
}

// The same integral along t + i turn tanh(t), where exp(-z cosh) falls although z is close to the imaginary axis.
BesselK turnedIntegral(Complex z) {
    constexpr double step = 1.0 / 16;
    const double turn = -std::arg(z);
    Complex K0, K1;
    for (int i = 0; i * step < 7; ++i) {
        const double t = i * step, slope = std::tanh(t), half = i == 0 ? 0.5 : 1;
        const Complex at(t, turn * slope), cosh = std::cosh(at);
        const Complex term = half * Complex(1, turn * (1 - slope * slope)) * std::exp(-z * cosh);
        K0 += term;
        K1 += term * cosh;
        if (std::abs(term) < 1e-17 * std::abs(K0)) break;
    }
    return {step * K0, step * K1};
}

// [Abramowitz1964] 9.7.2. Terms fall until n = 2 |z|.
BesselK asymptoticSeries(Complex z) {
    Complex sums[2];
    for (const int order : {0, 1}) {
        Complex term = 1, sum = 1;
        for (int n = 1; n < 36 && std::abs(term) > 1e-17; ++n) {
            term *= (4.0 * order - (2.0 * n - 1) * (2.0 * n - 1)) / (8.0 * n * z);
            sum += term;
        }
        sums[order] = sum;
    }
    const Complex scale = std::sqrt(std::numbers::pi / (2.0 * z)) * std::exp(-z);
    return {scale * sums[0], scale * sums[1]};
}

}  // namespace

BesselK besselK(Complex z) {
    const double size = std::abs(z);
    if (size < 2) return ascendingSeries(z);
    if (size >= 18) return asymptoticSeries(z);
    // Slightly more than pi/4: rounding of the argument.
    return std::abs(z.imag()) <= 1.0001 * z.real() ? integral(z) : turnedIntegral(z);
}

}  // namespace searchlight
