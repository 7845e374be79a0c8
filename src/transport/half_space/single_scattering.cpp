#include "transport/half_space/single_scattering.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "transport/walk/fresnel.h"
#include "transport/walk/quadrature.h"

namespace searchlight {

namespace {

// Light scattered at the length t of the beam into the direction (mu, phi) of the way back leaves at t Q from the
// entry, Q = (sine + cosine tan cos phi, cosine tan sin phi), with weight exp(-t - t cosine / mu): the integral over t
// is closed
// ([Habel2013] section 5 at normal incidence, with unreduced coefficients). Directions are drawn up by the polar
// coordinates (rho, alpha) of Q, so that radii go with rho alone; v = 1 / sqrt(1 + (rho / cosine)^2) is mu at normal
// incidence, and dmu dphi = (mu / v)^3 dv dalpha.
class Quadrature {
public:
    Quadrature(const HalfSpaceWalk& walk, std::span<const double> edges)
        : walk_(walk), edges_(edges), sine_(walk.sin_beam), cosine_(walk.cos_beam) {
        const double critical = criticalCosine(walk.eta);
        tangent_ = critical > 0 ? std::sqrt(1 - critical * critical) / critical : 0;
        critical_ = critical;
    }

    /// Midpoints of so many equal parts of half a turn of alpha, and so many parts of a panel in v; what they miss
    /// falls exponentially.
    SingleScattering with(int count, int parts) const {
        SingleScattering single;
        single.flux.assign(edges_.size() + 1, 0.0);
        for (int i = 0; i < count; ++i)
            addAzimuth(std::cos((i + 0.5) * std::numbers::pi / count), 1.0 / count, parts, single);
        return single;
    }

private:
    void addAzimuth(double cos_alpha, double share, int parts, SingleScattering& single) const {
        // Where this azimuth leaves the escape cone, a circle of its own in the plane of Q.
        double low = 0;
        if (critical_ > 0) {
            const double radius = cosine_ * tangent_, sin2_alpha = 1 - cos_alpha * cos_alpha;
            const double most =
                sine_ * cos_alpha + std::sqrt(std::max(0.0, radius * radius - sine_ * sine_ * sin2_alpha));
            low = cosine_ / std::hypot(cosine_, most);
        }
        // v = low + range q^2 smooths the root of the transmittance at the critical cosine; 1 - q = p^2 spreads out
        // the small radii, which come from v near 1. The two halves meet at q = 1/2.
        const double range = 1 - low;
        static const GaussLegendre rule;
        for (std::size_t i = 0; i < GaussLegendre::kPoints; ++i)
            for (int panel = 0; panel < 2 * parts; ++panel) {
                const double width = 0.25 / parts, q = width * (panel + rule.x[i]), dq = width * rule.weight[i];
                add(low + range * q * q, range * (1 - q * q), range * 2 * q * dq * share, cos_alpha, single);
            }
        integrateTowardsZero(std::sqrt(0.5), parts, [&](double p, double dp) {
            const double q = 1 - p * p;
            add(low + range * q * q, range * p * p * (1 + q), range * 4 * q * p * dp * share, cos_alpha, single);
        });
    }

    void add(double v, double one_minus_v, double dv, double cos_alpha, SingleScattering& single) const {
        const double g = walk_.g, rho = cosine_ * std::sqrt(one_minus_v * (1 + v)) / v, q_x = rho * cos_alpha;
        const double tan2 = std::max(0.0, rho * rho - 2 * q_x * sine_ + sine_ * sine_) / (cosine_ * cosine_);
        const double mu = 1 / std::sqrt(1 + tan2);
        const double turn = mu * ((q_x - sine_) * sine_ / cosine_ - cosine_);  // cosine of the angle of scattering
        const double phase = 0.5 * (1 - g * g) / std::pow((1 - g) * (1 - g) + 2 * g * (1 - turn), 1.5);
        const double transmitted = 1 - internalReflectance(walk_.eta, mu), stretch = mu / v;
        const double weight =
            (1 - walk_.absorbed) * phase * transmitted * mu / (mu + cosine_) * stretch * stretch * stretch * dv;
        const double length = mu / (mu + cosine_);  // mean of t
        single.total += weight;
        single.x += weight * q_x * length;
        single.r2 += weight * 2 * rho * rho * length * length;
        const double rate = 1 / (rho * length);  // of exp(-rate r)
        double inner = 1;
        for (std::size_t i = 0; i < edges_.size(); ++i) {
            const double depth = edges_[i] * rate, outer = depth < kNothing ? std::exp(-depth) : 0;
            single.flux[i] += weight * (inner - outer);
            if (outer == 0) return;
            inner = outer;
        }
        single.flux.back() += weight * inner;
    }

    static constexpr double kNothing = 45;

    const HalfSpaceWalk& walk_;
    std::span<const double> edges_;
    double sine_, cosine_, critical_ = 0, tangent_ = 0;
};

}  // namespace

SingleScattering singleScattering(const HalfSpaceWalk& walk, std::span<const double> edges) {
    const Quadrature quadrature(walk, edges);
    if (walk.sin_beam == 0) return quadrature.with(1, 1);
    constexpr int fewest = 12, most = 400;
    constexpr double enough = 1e-7;
    SingleScattering result = quadrature.with(fewest, 1);
    result.error = 1;
    for (int count = 2 * fewest; count <= most && result.error > enough; count *= 2) {
        SingleScattering fine = quadrature.with(count, count / fewest);
        double change =
            std::max({std::abs(fine.total - result.total), std::abs(fine.x - result.x), std::abs(fine.r2 - result.r2)});
        for (std::size_t i = 0; i < fine.flux.size(); ++i)
            change = std::max(change, std::abs(fine.flux[i] - result.flux[i]));
        result = std::move(fine);
        result.error = result.total > 0 ? change / result.total : 0;
    }
    return result;
}

}  // namespace searchlight
