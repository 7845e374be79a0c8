#include "transport/half_space/single_scattering.h"

#include <array>
#include <cmath>
#include <numbers>

#include "transport/walk/fresnel.h"

namespace searchlight {

namespace {

constexpr int kPoints = 16;

struct GaussLegendre {
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

// Sum over panels [h / 2, h] that shrink towards 0, where the integrand has its scales, from `top` down.
template <class F>
void integrate(double top, F&& f) {
    static const GaussLegendre rule;
    constexpr int panels = 28;
    double high = top;
    for (int panel = 0; panel < panels; ++panel) {
        const double low = panel + 1 < panels ? 0.5 * high : 0;
        for (std::size_t i = 0; i < kPoints; ++i) f(low + (high - low) * rule.x[i], (high - low) * rule.weight[i]);
        high = low;
    }
}

}  // namespace

SingleScattering singleScattering(const HalfSpaceWalk& walk, std::span<const double> edges) {
    SingleScattering single;
    single.flux.assign(edges.size() + 1, 0.0);
    const double g = walk.g, critical = criticalCosine(walk.eta);
    // Scattered at depth t into the cosine mu of the way back, light leaves at r = t tan with weight exp(-t - t / mu):
    // the integral over t is closed ([Habel2013] section 5, with unreduced coefficients).
    const auto add = [&](double mu, double one_minus_mu, double dmu) {
        const double phase = 0.5 * (1 - g * g) / std::pow((1 - g) * (1 - g) + 2 * g * (1 + mu), 1.5);
        const double transmitted = 1 - internalReflectance(walk.eta, mu);
        const double weight = (1 - walk.absorbed) * phase * transmitted * mu / (1 + mu) * dmu;
        const double rate = (1 + mu) / std::sqrt(one_minus_mu * (1 + mu));  // of exp(-rate r)
        single.total += weight;
        single.r2 += weight * 2 / (rate * rate);
        double inner = 1;
        for (std::size_t i = 0; i < edges.size(); ++i) {
            const double outer = std::exp(-edges[i] * rate);
            single.flux[i] += weight * (inner - outer);
            inner = outer;
        }
        single.flux.back() += weight * inner;
    };
    // mu = critical + range q^2 smooths the root of the transmittance at the critical cosine; 1 - q = p^2 spreads out
    // the small radii, which come from mu near 1. The two halves meet at q = 1/2.
    const double range = 1 - critical;
    integrate(0.5,
              [&](double q, double dq) { add(critical + range * q * q, range * (1 - q * q), range * 2 * q * dq); });
    integrate(std::sqrt(0.5), [&](double p, double dp) {
        const double q = 1 - p * p;
        add(critical + range * q * q, range * p * p * (1 + q), range * 4 * q * p * dp);
    });
    return single;
}

}  // namespace searchlight
