#include "transport/half_space/single_scattering.h"

#include <cmath>

#include "transport/half_space/quadrature.h"
#include "transport/walk/fresnel.h"

namespace searchlight {

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
    integrateTowardsZero(
        0.5, 1, [&](double q, double dq) { add(critical + range * q * q, range * (1 - q * q), range * 2 * q * dq); });
    integrateTowardsZero(std::sqrt(0.5), 1, [&](double p, double dp) {
        const double q = 1 - p * p;
        add(critical + range * q * q, range * p * p * (1 + q), range * 4 * q * p * dp);
    });
    return single;
}

}  // namespace searchlight
