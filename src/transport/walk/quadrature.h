// Integrals whose integrand has its scales near one end.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace searchlight {

/// Gauss-Legendre quadrature on [0, 1], exact for polynomials up to the degree 31.
struct GaussLegendre {
    static constexpr int kPoints = 16;
    std::array<double, kPoints> x{}, weight{};  // on [0, 1]

    GaussLegendre() {
        for (std::size_t i = 0; i < kPoints; ++i) {
            double z = std::cos(std::numbers::pi * (static_cast<double>(i) + 0.75) / (kPoints + 0.5)), slope = 1;
            for (int newton = 0; newton < 8; ++newton) {
                double p = 1, before = 0;
                for (int n = 1; n <= kPoints; ++n) {
                    const double next = ((2 * n - 1) * z * p - (n - 1) * before) / n;
                    before = p;
                    p = next;
                }
                slope = kPoints * (z * p - before) / (z * z - 1);
                z -= p / slope;
            }
            x[i] = 0.5 * (1 + z);
            weight[i] = 1 / ((1 - z * z) * slope * slope);
        }
    }
};

/// Calls f(x, weight of x) for an integral from 0 to `top`: panels [h / 2, h] shrink towards 0. The four largest have
/// so many parts, for an integrand with kinks.
template <class F>
void integrateTowardsZero(double top, int parts, F&& f) {
    static const GaussLegendre rule;
    constexpr int panels = 28, large = 4;
    double high = top;
    for (int panel = 0; panel < panels; ++panel) {
        const double low = panel + 1 < panels ? 0.5 * high : 0;
        const int count = panel < large ? parts : 1;
        const double width = (high - low) / count;
        for (int part = 0; part < count; ++part)
            for (std::size_t i = 0; i < GaussLegendre::kPoints; ++i)
                f(low + width * (part + rule.x[i]), width * rule.weight[i]);
        high = low;
    }
}

}  // namespace searchlight
