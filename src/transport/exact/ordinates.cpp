// With k along x, directions (mu, phi) of both hemispheres and q = 1 - rate s cos(phi), s = sqrt(1 - mu^2), light of
// wavefront exp(i k x) that goes down (d) and up (u) obeys
//   mu d' = -q d + a (P+ d + P- u) + a p(mu) exp(-z),   -mu u' = -q u + a (P- d + P+ u) + a p(-mu) exp(-z):
// the sources are the beam's first scattering. The half-space answers what comes down by u = R d + v exp(-z), where
// R = (Z - 1) (Z + 1)^-1 and Z is the corner of the sign function of ((0, M+), (M-, 0)), M+- = (q - a (P+ -+ P-)) / mu:
// the modes that decay downwards, [Roberts1980]. The surface sends d = F u down again.
//
// What has been scattered once or twice varies with phi as fast as q, which no few directions follow: these two orders
// are taken off as the same directions have them, and put back as they are. The azimuths are crowded about those across
// k, where q varies, in proportion to 1 / |rate|.
#include "transport/exact/ordinates.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "transport/exact/ordinate_orders.h"
#include "transport/walk/fresnel.h"

namespace searchlight {

namespace {

using Complex = std::complex<double>;
using std::numbers::pi;
using Matrix = Eigen::MatrixXcd;
using Vector = Eigen::VectorXcd;

constexpr int kMostSteps = 60;  // of Newton's iteration; 20 were seen at rates of 1e3
constexpr double kSmallestMoment = 1e-9;
// |g| is at most 1/2, so that no peak is set apart.
constexpr int kManyMoments = 60;

struct Cosine {
    double mu, weight;
};

// Cosines of the hemisphere, and so many azimuths at each; mirrored at the plane of k, so that a weight holds both.
LayerRays raysOf(const OrdinateMedium& medium, const std::vector<Cosine>& cosines, int azimuths, Complex rate) {
    const GaussRule rule = gaussRule(azimuths);
    LayerRays rays;
    rays.set.azimuths = rule.x.size();
    for (const Cosine& at : cosines) {
        const double sine = std::sqrt((1 - at.mu) * (1 + at.mu));
        const double width = std::min(1.0, 1 / (std::abs(rate) * sine + 1e-300)), end = std::asinh(0.5 * pi / width);
        const double reflectance = medium.eta == 1 ? 0 : internalReflectance(medium.eta, at.mu);
        for (std::size_t j = 0; j < rule.x.size(); ++j) {
            // From the direction across k.
            const double x = end * (2 * rule.x[j] - 1), angle = width * std::sinh(x);
            rays.set.mu.push_back(at.mu);
            rays.set.weight.push_back(at.weight * 4 * end * rule.weight[j] * width * std::cosh(x));
            rays.set.phi.push_back(0.5 * pi - angle);
            rays.along.push_back(sine * std::sin(angle));
            rays.across.push_back(sine * std::cos(angle));
            rays.Q.push_back((1.0 - rate * rays.along.back()) / at.mu);
            rays.F_up.push_back(reflectance);
            rays.F_down.push_back(0);
            rays.up.push_back(1 - reflectance);
            rays.down.push_back(0);
        }
    }
    return rays;
}

std::vector<Cosine> cosinesOf(const OrdinateMedium& medium, const OrdinateCount& count) {
    std::vector<Cosine> cosines;
    const double critical = criticalCosine(medium.eta);
    const GaussRule escaping = gaussRule(count.escaping);
    if (critical == 0) {
        for (std::size_t i = 0; i < escaping.x.size(); ++i) cosines.push_back({escaping.x[i], escaping.weight[i]});
        return cosines;
    }
    const GaussRule reflected = gaussRule(count.reflected);
    for (std::size_t i = 0; i < reflected.x.size(); ++i)
        cosines.push_back({critical * reflected.x[i], critical * reflected.weight[i]});
    // The square smooths the root in T at the critical cosine.
    for (std::size_t i = 0; i < escaping.x.size(); ++i) {
        const double x = escaping.x[i];
        cosines.push_back({critical + (1 - critical) * x * x, 2 * (1 - critical) * x * escaping.weight[i]});
    }
    return cosines;
}

// Three parts: crowded towards the normal, where s is of the size of 1 / |rate|; up to the critical angle; beyond it.
std::vector<Cosine> fineCosines(const OrdinateMedium& medium, int count, Complex rate) {
    const double critical = std::acos(criticalCosine(medium.eta)), middle = 0.5 * critical;
    const double width = std::min(1.0, 1 / (std::abs(rate) + 1e-300)), end = std::asinh(middle / width);
    std::vector<Cosine> cosines;
    const GaussRule rule = gaussRule(count);
    const auto add = [&](double angle, double weight) {
        cosines.push_back({std::cos(angle), std::sin(angle) * weight});
    };
    for (std::size_t i = 0; i < rule.x.size(); ++i) {
        const double x = rule.x[i], w = rule.weight[i];
        add(width * std::sinh(end * x), end * width * std::cosh(end * x) * w);
        add(critical - (critical - middle) * x * x, 2 * (critical - middle) * x * w);
        const double mu = std::cos(critical) * x;
        if (medium.eta > 1) cosines.push_back({mu, std::cos(critical) * w});
    }
    return cosines;
}

// Z of the comment above: Newton's iteration for the sign, with determinants as scale. Modes decay where the continued
// square root of their eigenvalue leads from k = 0 to here: all of them in the half plane about the middle of q.
Matrix decayingModes(Matrix plus, Matrix minus, Complex rate) {
    const Complex turn = std::polar(1.0, -0.5 * (std::arg(1.0 - rate) + std::arg(1.0 + rate)));
    plus *= turn;
    minus *= turn;
    const double n = static_cast<double>(plus.rows());
    for (int step = 0; step < kMostSteps; ++step) {
        const Eigen::PartialPivLU<Matrix> plus_lu(plus), minus_lu(minus);
        double log_size = 0;
        for (Eigen::Index i = 0; i < plus.rows(); ++i)
            log_size += std::log(std::abs(plus_lu.matrixLU()(i, i))) + std::log(std::abs(minus_lu.matrixLU()(i, i)));
        const double scale = std::exp(-log_size / (2 * n));
        const Matrix next = 0.5 * (scale * plus + minus_lu.inverse() / scale);
        minus = 0.5 * (scale * minus + plus_lu.inverse() / scale);
        const double change = (next - plus).norm() / next.norm();
        plus = next;
        if (change < 1e-9) break;  // quadratic: what is left is below rounding
    }
    return plus;
}

// The half-space as a layer, under a beam of unit flux.
OrdinateStack::Layer layerOf(const OrdinateMedium& medium, int last_moment) {
    return {.n = medium.eta,
            .sigma_t = 1,
            .sigma_s = medium.albedo,
            .thickness = std::numeric_limits<double>::infinity(),
            .phase = smoothPhase(medium.g, last_moment),
            .beam_down = 1};
}

}  // namespace

Complex secondOrderTransform(const OrdinateMedium& medium, const OrdinateCount& count, Complex rate) {
    const LayerRays rays = raysOf(medium, fineCosines(medium, count.second_panel, rate), count.second_azimuths, rate);
    return secondOrder(layerOf(medium, kManyMoments), rays, nullptr).R;
}

Complex ordinateTransform(const OrdinateMedium& medium, const OrdinateCount& count, Complex rate) {
    const LayerRays at = raysOf(medium, cosinesOf(medium, count), count.azimuths, rate);
    std::vector<double> moments;
    for (double moment = 1; std::abs(moment) > kSmallestMoment && moments.size() < 2 * at.size() / at.set.azimuths - 1;
         moment *= medium.g)
        moments.push_back(moment);
    const OrdinateScattering scattering = ordinateScattering(moments, at.set);
    const auto n = static_cast<Eigen::Index>(at.size());
    const double a = medium.albedo;
    Matrix alpha(n, n), beta(n, n);
    Vector down(n), up(n);
    for (Eigen::Index i = 0; i < n; ++i) {
        const auto to = static_cast<std::size_t>(i);
        for (Eigen::Index j = 0; j < n; ++j) {
            const auto from = static_cast<std::size_t>(j);
            const double part = a * at.set.weight[from] / at.set.mu[to];
            alpha(i, j) = -part * scattering.same[to * at.size() + from];
            beta(i, j) = part * scattering.other[to * at.size() + from];
        }
        alpha(i, i) += at.Q[to];
        down[i] = a * scattering.down[to] / at.set.mu[to];
        up[i] = a * scattering.up[to] / at.set.mu[to];
    }
    const Matrix one = Matrix::Identity(n, n), modes = decayingModes(alpha + beta, alpha - beta, rate);
    const Matrix reflection = (modes + one).transpose().partialPivLu().solve((modes - one).transpose()).transpose();
    Vector leaving = (alpha + one - reflection * beta).partialPivLu().solve(up + reflection * down);
    if (medium.eta != 1) {
        Matrix surface = one;
        for (Eigen::Index j = 0; j < n; ++j) surface.col(j) -= at.F_up[static_cast<std::size_t>(j)] * reflection.col(j);
        leaving = surface.partialPivLu().solve(leaving);
    }
    Complex sum = 0;
    for (Eigen::Index i = 0; i < n; ++i) {
        const auto to = static_cast<std::size_t>(i);
        sum += at.set.weight[to] * (1 - at.F_up[to]) * at.set.mu[to] * leaving[i];
    }
    const OrdinateStack::Layer layer = layerOf(medium, kManyMoments);
    sum -= firstOrder(layer, at, scattering).R + secondOrder(layer, at, &scattering).R;
    return sum + secondOrderTransform(medium, count, rate);
}

double diffusionRate(const OrdinateMedium& medium) {
    if (medium.albedo >= 1) return 0;
    // The determinant by its continued fraction; its sign changes at the rate.
    const auto balance = [&](double rate) {
        double rest = 0;
        for (int l = 400; l >= 1; --l)
            rest = static_cast<double>(l) * l * rate * rate /
                   ((2 * l + 1) * (1 - medium.albedo * std::pow(medium.g, l)) - rest);
        return 1 - medium.albedo - rest;
    };
    double low = 1e-12, high = 1;
    for (int i = 0; i < 100; ++i) {
        const double middle = std::sqrt(low * high);
        (balance(middle) > 0 ? low : high) = middle;
    }
    return low;
}

}  // namespace searchlight
