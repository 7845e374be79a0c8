// A transverse frequency k turns the searchlight into a problem of depth alone, whose H function obeys
//   ln H_k(nu) = -(nu / pi) int_0^inf ln Lambda(w^2 + k^2) / (1 + nu^2 w^2) dw,  Lambda(q^2) = 1 - a atan(q) / q,
// in mean free paths, [Rybicki1971]; k = 0 is [Chandrasekhar1960] chapter V. The Hankel transform of the exitance is
//   R^(k) = (a / 2) H_k(1) int_1^inf H_k(1/p) / (1 + p) s^-2 ds,  p^2 = s^2 + k^2,
// of which H = 1 is single scattering, summed apart. R^ is analytic in k but for cuts on the imaginary axis from nu0,
// the root of Lambda(-nu0^2) = 0, outwards. So the Hankel inversion, which oscillates on the real axis, is carried on a
// hyperbola about a cut, where it decays as exp(-kappa r), k = i kappa:
//   kappa = nu0 cosh(u - i tilt):  R(r) = -(1 / pi^2) Im int_0^inf R^ K0(kappa r) kappa dkappa/du du.
// The trapezoidal rule converges exponentially there, [Trefethen2014], and the relative error hardly grows with r.
#include "transport/exact/exact_half_space.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

#include "base/error.h"
#include "transport/exact/complex_bessel.h"

namespace searchlight {

namespace {

using Complex = std::complex<double>;
using std::numbers::pi;

// Rounding and truncation of one node of the contour, relative. Refining every step shows a fifth of it at most.
constexpr double kNodeError = 2e-14;
// In mean free paths. Closer to the beam, multiple scattering is less than 1e-6 of the exitance.
constexpr double kSmallestRadius = 1e-7;
// At the smallest radius exp(-kappa r cos(tilt)) is 1e-30 there.
constexpr double kLargestRate = 100 / kSmallestRadius;
// exp(-45) is 3e-20.
constexpr double kNegligible = 45;
constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

// log(1 + z) and exp(z) - 1 without cancellation near z = 0.
Complex log1p(Complex z) {
    return {0.5 * std::log1p(z.real() * (2 + z.real()) + z.imag() * z.imag()), std::atan2(z.imag(), 1 + z.real())};
}
Complex expm1(Complex z) {
    const double half = std::sin(0.5 * z.imag());
    return {std::expm1(z.real()) * std::cos(z.imag()) - 2 * half * half, std::exp(z.real()) * std::sin(z.imag())};
}

struct Phase {
    double albedo, absorbed;  // their sum is 1, each without cancellation

    // ln Lambda(q^2), accurate where Lambda is near 0 as where it is near 1.
    Complex logLambda(Complex q2) const {
        const Complex q = std::sqrt(q2), arc = std::abs(q2) > 0.1 ? std::atan(q) / q : 1.0 - smallDefect(q2);
        return albedo * std::abs(arc) < 0.5 ? log1p(-albedo * arc) : std::log(lambda(q2));
    }

    Complex lambda(Complex q2) const {
        const Complex q = std::sqrt(q2);
        return absorbed + albedo * (std::abs(q2) > 0.1 ? 1.0 - std::atan(q) / q : smallDefect(q2));
    }

    // 1 - atan(q) / q as a series for |q^2| < 0.1; 0.1^17 is below rounding.
    static Complex smallDefect(Complex q2) {
        Complex sum = 0;
        for (int n = 17; n >= 1; --n) sum = q2 * (1.0 / (2 * n + 1) - sum);
        return sum;
    }

    // The least rate at which light decays sideways, nu0, the inverse of the diffusion length. Media that absorb less
    // than their rounding get 1e-13: so close to the beginning of the cut the flux that the hyperbola cuts off is as
    // small.
    double diffusionRate() const {
        double low = std::log(1e-13), high = 0;
        for (int i = 0; i < 60; ++i) {
            const double middle = 0.5 * (low + high), rate = std::exp(middle);
            (lambda(-rate * rate).real() > 0 ? low : high) = middle;
        }
        return std::exp(low);
    }
};

// ln H_k at many nu for one k: the logarithm of Lambda is sampled once.
class LogH {
public:
    // The sinh crowds points where Lambda changes, at the scale of the diffusion rate or of k, and where nu does, at 1.
    LogH(const Phase& phase, Complex rate, double diffusion_rate, double step) {
        const double size = std::abs(rate), scale = std::clamp(size / 8, diffusion_rate, 1.0);
        const double last = std::asinh(1e8 * std::max(1.0, size) / scale);
        for (int i = 0; i * step < last; ++i) {
            const double x = i * step, w = scale * std::sinh(x),
                         weight = scale * std::cosh(x) * step * (i == 0 ? 0.5 : 1);
            const Complex log_lambda = weight * phase.logLambda(w * w - rate * rate);
            w2_.push_back(w * w);
            real_.push_back(log_lambda.real());
            imag_.push_back(log_lambda.imag());
        }
    }

    // ln H_k(1/p).
    Complex operator()(Complex p) const {
        const Complex p2 = p * p;
        const double a = p2.real(), b = p2.imag();
        double real = 0, imag = 0;
        for (std::size_t j = 0; j < w2_.size(); ++j) {
            const double c = a + w2_[j], inverse = 1 / (c * c + b * b);
            real += (real_[j] * c + imag_[j] * b) * inverse;
            imag += (imag_[j] * c - real_[j] * b) * inverse;
        }
        return -p / pi * Complex(real, imag);
    }

private:
    std::vector<double> w2_, real_, imag_;
};

// R^ of two and more scatters.
Complex multipleTransform(const Phase& phase, Complex rate, double diffusion_rate, double step) {
    const LogH log_h(phase, rate, diffusion_rate, 2 * step);
    const Complex log_h1 = log_h(1);
    const double last = std::log(1e17 * (1 + std::abs(rate)));
    Complex sum = 0;
    const double dx = 2 * step;
    for (int i = static_cast<int>(-3.75 / dx); i * dx < last; ++i) {
        // Doubly exponential towards s = 1, exponential towards infinity.
        const double x = i * dx, fall = std::exp(-x), beyond = std::exp(x - fall), s = 1 + beyond;
        const Complex p = std::sqrt(s * s - rate * rate);
        sum += expm1(log_h1 + log_h(p)) / (1.0 + p) * (beyond * (1 + fall) / (s * s));
    }
    return 0.5 * phase.albedo * dx * sum;
}

ExactOrders orders(Estimate single, Estimate multiple) {
    return {{single.mean + multiple.mean, single.standard_error + multiple.standard_error}, single, multiple};
}

ExactOrders scaled(ExactOrders value, double unit) {
    for (Estimate* order : {&value.all, &value.single, &value.multiple})
        *order = {order->mean * unit, order->standard_error * unit};
    return value;
}

Phase phaseOf(double sigma_a, double sigma_s) {
    if (!(sigma_a >= 0 && sigma_s >= 0 && std::isfinite(sigma_a + sigma_s) && sigma_a + sigma_s > 0))
        throw inputError(fmt::format("sigma_a {} and sigma_s {} make no medium", sigma_a, sigma_s),
                         "0 or more 1/mm, not both 0");
    return {sigma_s / (sigma_a + sigma_s), sigma_a / (sigma_a + sigma_s)};
}

}  // namespace

ExactOrders exactTotal(double sigma_a, double sigma_s, double mu0) {
    const Phase phase = phaseOf(sigma_a, sigma_s);
    if (!(mu0 > 0 && mu0 <= 1)) throw inputError(fmt::format("the cosine of incidence is {}", mu0), "above 0, up to 1");
    const double single = 0.5 * phase.albedo * (1 - mu0 * std::log1p(1 / mu0));
    double all = 1;
    if (phase.absorbed > 0) {
        const LogH log_h(phase, 0, phase.diffusionRate(), 0.125);
        all = -std::expm1(log_h(1 / mu0).real() + 0.5 * std::log(phase.absorbed));
    }
    const double error = 10 * kEpsilon;
    return {{all, error}, {single, error * single}, {all - single, error}};
}

ExactHalfSpace::ExactHalfSpace(HankelSolution solution) : solution_(std::move(solution)) {}

ExactHalfSpace::ExactHalfSpace(double sigma_a, double sigma_s, const ExactQuadrature& quadrature) {
    const Phase phase = phaseOf(sigma_a, sigma_s);
    solution_.sigma_t = sigma_a + sigma_s;
    solution_.absorbs = phase.absorbed > 0;
    solution_.multiple_total = exactTotal(sigma_a, sigma_s, 1).multiple.mean;
    solution_.multiple_total_error = 10 * kEpsilon;
    solution_.single_error = kNodeError;
    solution_.smallest_radius = kSmallestRadius;
    // Where K0 ceases to decay, on the far side of the contour. Measured: up to 180 of this, beyond 50 diffusion
    // lengths; so 1000.
    solution_.contour_error = 1000 * std::exp(-2 * pi * (0.5 * pi - quadrature.tilt) / quadrature.step);

    const double diffusion_rate = phase.diffusionRate();
    const double last = std::log(2 * kLargestRate / diffusion_rate);
    for (int i = 0; i * quadrature.step < last; ++i) {
        const Complex v(i * quadrature.step, -quadrature.tilt);
        const Complex rate = diffusion_rate * std::cosh(v);
        const Complex transform = multipleTransform(phase, rate, diffusion_rate, quadrature.step);
        solution_.contour.push_back(
            {rate, (i == 0 ? 0.5 : 1) * quadrature.step * diffusion_rate * std::sinh(v) * transform});
    }

    // Single scattering at depth t leaves at r with exp(-t - sqrt(r^2 + t^2)) = exp(-tau r), tau from 1 to infinity.
    // tau = 1 + e^x; beyond the ends are 1e-17 of the flux at any radius that the contour resolves.
    const double dx = 2.5 * quadrature.step;
    for (int i = static_cast<int>(-28 / dx); i * dx < 40; ++i) {
        const double above = std::exp(i * dx), tau = 1 + above, square = tau * tau + 1;
        solution_.single.push_back({tau, phase.albedo * dx * above * above * (2 + above) / (square * square)});
    }
}

ExactOrders ExactHalfSpace::total() const {
    double single = 0;
    for (const HankelSolution::Single& node : solution_.single) single += node.weight / node.rate;
    return orders({single, solution_.single_error * single},
                  {solution_.multiple_total, solution_.multiple_total_error});
}
ExactOrders ExactHalfSpace::within(double r_mm) const { return flux(0, r_mm * solution_.sigma_t); }
ExactOrders ExactHalfSpace::beyond(double r_mm) const {
    return flux(r_mm * solution_.sigma_t, std::numeric_limits<double>::infinity());
}

ExactOrders ExactHalfSpace::annulusRd(double inner_mm, double outer_mm) const {
    const double area = pi * (outer_mm - inner_mm) * (outer_mm + inner_mm);
    return scaled(flux(inner_mm * solution_.sigma_t, outer_mm * solution_.sigma_t), 1 / area);
}

ExactOrders ExactHalfSpace::Rd(double r_mm) const {
    const double r = r_mm * solution_.sigma_t;
    if (!(r >= solution_.smallest_radius))
        throw inputError(fmt::format("the exitance at {} mm is asked for; it grows as 1/r towards the beam", r_mm),
                         fmt::format("at least {:.3g} mean free paths", solution_.smallest_radius));
    double single = 0;
    for (const HankelSolution::Single& node : solution_.single) single += node.weight * std::exp(-node.rate * r);
    single /= 2 * pi * r;
    double multiple = 0, size = 0;
    Complex doubt = 0;
    for (const HankelSolution::Node& node : solution_.contour) {
        const Complex wave = node.rate * besselK(node.rate * r).K0 / (pi * pi), term = node.weight * wave;
        multiple -= term.imag();
        size += std::abs(term);
        doubt += node.doubt * wave;
        if ((node.rate - solution_.contour.front().rate).real() * r > kNegligible) break;
    }
    const double rounding = kNodeError + kEpsilon * r;
    return scaled(orders({single, (solution_.single_error + kEpsilon * r) * single},
                         {multiple, std::abs(doubt) + rounding * size +
                                        solution_.contour_error * solution_.multiple_total / (pi * r * r)}),
                  solution_.sigma_t * solution_.sigma_t);
}

// Between two radii in mean free paths; the outer one may be infinite.
ExactOrders ExactHalfSpace::flux(double inner, double outer) const {
    if (inner == 0 && solution_.ends_early) {
        if (std::isinf(outer)) return total();
        const ExactOrders all = total(), rest = flux(outer, std::numeric_limits<double>::infinity());
        const auto left = [](const Estimate& whole, const Estimate& part) {
            return Estimate{whole.mean - part.mean, whole.standard_error + part.standard_error};
        };
        return orders(left(all.single, rest.single), left(all.multiple, rest.multiple));
    }
    double single = 0;
    for (const HankelSolution::Single& node : solution_.single)
        single -= node.weight / node.rate * std::exp(-node.rate * inner) * std::expm1(-node.rate * (outer - inner));
    const auto rK1 = [](Complex rate, double r) {
        if (std::abs(rate) * r < 1e-9) return 1.0 / rate;  // the next term is 1e-17 of it
        return rate.real() * r > 700 ? Complex() : r * besselK(rate * r).K1;
    };
    double multiple = 0, size = 0, cancelled = 0;
    Complex doubt = 0;
    for (const HankelSolution::Node& node : solution_.contour) {
        if ((node.rate - solution_.contour.front().rate).real() * inner > kNegligible) break;
        const Complex from_inner = rK1(node.rate, inner), from_outer = rK1(node.rate, outer);
        const Complex wave = 2 / pi * (from_inner - from_outer), term = node.weight * wave;
        multiple -= term.imag();
        doubt += node.doubt * wave;
        size += std::abs(term);
        cancelled += std::abs(2 / pi * node.weight * from_inner);
    }
    const double rounding = kNodeError + kEpsilon * inner;
    return orders({single, (solution_.single_error + kEpsilon * inner) * single},
                  {multiple, std::abs(doubt) + rounding * size + 4 * kEpsilon * cancelled +
                                 solution_.contour_error * solution_.multiple_total});
}

ExactOrders ExactHalfSpace::meanR2() const {
    double single = 0, multiple = 0, size = 0;
    Complex doubt = 0;
    for (const HankelSolution::Single& node : solution_.single)
        single += 2 * node.weight / (node.rate * node.rate * node.rate);
    for (const HankelSolution::Node& node : solution_.contour) {
        const Complex wave = 8 / pi / (node.rate * node.rate * node.rate), term = node.weight * wave;
        multiple -= term.imag();
        doubt += node.doubt * wave;
        size += std::abs(term);
    }
    if (!solution_.absorbs) multiple = std::numeric_limits<double>::infinity();
    const ExactOrders sum = orders({single, solution_.single_error * single},
                                   {multiple, std::abs(doubt) + kNodeError * size}),
                      flux = total();
    const auto mean = [&](const Estimate& moment, const Estimate& of) {
        const double unit = 1 / (of.mean * solution_.sigma_t * solution_.sigma_t);
        const double relative = of.mean > 0 ? of.standard_error / of.mean : 0;
        return Estimate{moment.mean * unit,
                        moment.standard_error * unit + (kNodeError + relative) * moment.mean * unit};
    };
    return {mean(sum.all, flux.all), mean(sum.single, flux.single), mean(sum.multiple, flux.multiple)};
}

std::string whyNotExact(const HalfSpaceProblem& problem) {
    if (problem.eta != 1) return fmt::format("the boundary refracts, eta {}", problem.eta);
    if (problem.g != 0) return fmt::format("the scattering is not isotropic, g {}", problem.g);
    if (problem.angle_deg != 0) return fmt::format("the beam is oblique, {} deg", problem.angle_deg);
    return {};
}

HalfSpaceResult solveHalfSpace(const HalfSpaceProblem& problem, const std::vector<double>& edges_mm) {
    if (const std::string reason = whyNotExact(problem); !reason.empty())
        throw inputError("no exact solution: " + reason, "eta 1, g 0, normal incidence; or walk it");
    const auto start = std::chrono::steady_clock::now();
    HalfSpaceResult result = tallyExact(ExactHalfSpace(problem.sigma_a, problem.sigma_s), edges_mm);
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return result;
}

HalfSpaceResult tallyExact(const ExactHalfSpace& exact, const std::vector<double>& edges_mm) {
    if (edges_mm.size() < 2) throw inputError("radial bins need at least 2 edges");
    if (!(edges_mm.front() >= 0 && std::isfinite(edges_mm.back())) ||
        !std::ranges::is_sorted(edges_mm, std::ranges::less_equal()))
        throw inputError("the edges of the radial bins do not ascend from 0 or more");
    HalfSpaceResult result;
    // Each member of ExactOrders with the tally that it belongs to.
    const std::pair<Estimate ExactOrders::*, HalfSpaceTally*> tallies[] = {{&ExactOrders::all, &result.all},
                                                                           {&ExactOrders::single, &result.single},
                                                                           {&ExactOrders::multiple, &result.multiple}};
    const ExactOrders total = exact.total(), r2 = exact.meanR2();
    const ExactOrders inside = exact.within(edges_mm.front()), outside = exact.beyond(edges_mm.back());
    for (const auto& [order, tally] : tallies) {
        tally->total = total.*order;
        tally->mean_r2_mm2 = r2.*order;
        tally->beyond = {(inside.*order).mean + (outside.*order).mean};
    }
    for (std::size_t i = 0; i + 1 < edges_mm.size(); ++i) {
        const ExactOrders mean = exact.annulusRd(edges_mm[i], edges_mm[i + 1]);
        for (const auto& [order, tally] : tallies) {
            tally->Rd.push_back((mean.*order).mean);
            tally->standard_error.push_back((mean.*order).standard_error);
        }
    }
    result.threads = 1;
    return result;
}

}  // namespace searchlight
