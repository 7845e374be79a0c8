#include "kernel/gaussians.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.h"
#include "kernel/preintegrated.h"

namespace searchlight {

LineKernel gaussianLine(std::span<const double> weights, std::span<const double> variances_mm2) {
    double delta = 0, narrow = 0, wide = 0;
    for (std::size_t k = 0; k < weights.size(); ++k) {
        const double sigma = std::sqrt(variances_mm2[k]);
        if (sigma == 0) {
            delta += weights[k];
            continue;
        }
        narrow = narrow == 0 ? sigma : std::min(narrow, sigma);
        wide = std::max(wide, sigma);
    }
    double sum = -delta;
    for (const double weight : weights) sum += weight;
    if (wide == 0 || sum == 0) return LineKernel(delta);
    // A tenth of the narrowest, then 10 % apart but no more than a tenth of the widest.
    std::vector<double> x{0}, integral, density;
    while (x.back() < 6 * wide) x.push_back(x.back() + std::clamp(0.1 * x.back(), 0.1 * narrow, 0.1 * wide));
    for (const double at : x) {
        double inside = 0, value = 0;
        for (std::size_t k = 0; k < weights.size(); ++k) {
            const double v = variances_mm2[k];
            if (v == 0) continue;
            inside += 0.5 * weights[k] * std::erf(at / std::sqrt(2 * v));
            value += weights[k] * std::exp(-at * at / (2 * v)) / std::sqrt(2 * std::numbers::pi * v);
        }
        integral.push_back(inside);
        density.push_back(value);
    }
    // What a Gaussian has beyond 6 sigma, 2e-9, is not to be missing.
    const double factor = 0.5 * sum / integral.back();
    for (double& value : integral) value *= factor;
    return {std::move(x), std::move(integral), std::move(density), delta};
}

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Where the fit looks: a frequency, or an annulus; with the target there and the root of its weight.
struct Place {
    double a = 0, b = 0;  // the frequency; or the radii
    double target = 0, root = 0;
};

class GaussianFit {
public:
    GaussianFit(std::vector<Place> places, GaussianMeasure measure) : places_(std::move(places)), measure_(measure) {}

    // x: logarithms of the variances, then roots of the weights, which are divided by their sum.
    double run(VectorXd& x) const {
        double damping = 1e-2, value = objective(x, nullptr, nullptr);
        for (int step = 0; step < 60; ++step) {
            VectorXd gradient;
            MatrixXd normal;
            objective(x, &gradient, &normal);
            double after = value;
            while (damping < 1e8) {
                MatrixXd damped = normal;
                damped.diagonal() *= 1 + damping;
                damped.diagonal().array() += 1e-14 * normal.diagonal().maxCoeff();
                const VectorXd next = x - damped.ldlt().solve(gradient).cwiseMax(-1).cwiseMin(1);
                after = objective(next, nullptr, nullptr);
                damping *= after < value ? 0.2 : 5;
                if (after >= value) continue;
                x = next;
                break;
            }
            const bool done = after > (1 - 1e-6) * value;
            value = std::min(after, value);
            if (done) break;
        }
        return value;
    }

private:
    double objective(const VectorXd& x, VectorXd* gradient, MatrixXd* normal) const {
        const Index n = x.size() / 2;
        const bool any_mass = measure_ == GaussianMeasure::kernel_space_any_mass;
        const double sum = any_mass ? 1 : x.tail(n).squaredNorm();
        if (gradient) {
            *gradient = VectorXd::Zero(2 * n);
            *normal = MatrixXd::Zero(2 * n, 2 * n);
        }
        double total = 0;
        VectorXd value(n), slope(n), row(2 * n);
        for (const Place& place : places_) {
            double here = 0;
            for (Index k = 0; k < n; ++k) {
                const double v = std::exp(x(k));
                if (measure_ == GaussianMeasure::pictures) {
                    const double u = 0.5 * v * place.a * place.a;
                    value(k) = std::exp(-u);
                    slope(k) = -u * value(k);
                } else {
                    const double u = 0.5 * place.a * place.a / v, w = 0.5 * place.b * place.b / v;
                    value(k) = std::exp(-u) - std::exp(-w);
                    slope(k) = u * std::exp(-u) - w * std::exp(-w);
                }
                here += x(n + k) * x(n + k) / sum * value(k);
            }
            const double residual = place.root * (here - place.target);
            total += residual * residual;
            if (!gradient) continue;
            for (Index k = 0; k < n; ++k) {
                row(k) = place.root * x(n + k) * x(n + k) / sum * slope(k);
                row(n + k) = place.root * 2 * x(n + k) / sum * (value(k) - (any_mass ? 0 : here));
            }
            *gradient += residual * row;
            normal->selfadjointView<Eigen::Lower>().rankUpdate(row);
        }
        if (normal) *normal = normal->selfadjointView<Eigen::Lower>();
        return total;
    }

    std::vector<Place> places_;
    GaussianMeasure measure_;
};

std::vector<Place> placesOf(const GroundTruth& truth, const LineKernel& line, int channel, GaussianMeasure measure,
                            double cell_mm) {
    std::vector<Place> places;
    const double radius = truth.radiusOf(0.5, channel);
    if (measure == GaussianMeasure::pictures) {
        const double corner = 2 * std::numbers::pi / (16 * radius);
        for (double omega = 0.05 / radius; omega < 30 / radius; omega *= std::exp2(0.125)) {
            const double power = omega * omega / std::pow(omega * omega + corner * corner, 1.5);
            places.push_back({.a = omega, .target = line.transform(omega), .root = std::sqrt(power)});
        }
        return places;
    }
    // The energy of an annulus over its area is the mean density; its square counts with the area.
    const double first = cell_mm > 0 ? cell_mm : radius / 20;
    for (double r = 0, next = first; r < truth.extent(); r = next, next *= 1.06)
        places.push_back({.a = r,
                          .b = next,
                          .target = truth.encircled(next)[channel] - truth.encircled(r)[channel],
                          .root = 1 / std::sqrt(std::numbers::pi * (next * next - r * r))});
    return places;
}

}  // namespace

SeparableKernel fittedGaussians(const GroundTruth& truth, int count, GaussianMeasure measure, double cell_mm) {
    SeparableKernel kernel{.method = "gaussians", .terms = std::vector<KernelTerm>(static_cast<std::size_t>(count))};
    const std::array<LineKernel, Rgb::channels> lines = lineSpread(truth);
    for (int c = 0; c < Rgb::channels; ++c) {
        const auto channel = static_cast<std::size_t>(c);
        if (!truth.scatters(c)) {
            for (KernelTerm& term : kernel.terms) term.scale[c] = 1.0 / count;
            continue;
        }
        const GaussianFit fit(placesOf(truth, lines[channel], c, measure, cell_mm), measure);
        // Starts between two radii of the energy; the fit walks to the nearest minimum, so that a few are tried.
        VectorXd best;
        double least = 0;
        for (const double inner : {0.02, 0.1, 0.3}) {
            VectorXd x = VectorXd::Constant(2 * count, 1);
            const double from = truth.radiusOf(inner, c), to = truth.radiusOf(0.8, c);
            for (int k = 0; k < count; ++k)
                x(k) = 2 * std::lerp(std::log(from), std::log(to), count == 1 ? 0.5 : k / (count - 1.0)) - 0.7;
            const double value = fit.run(x);
            if (best.size() > 0 && value >= least) continue;
            least = value;
            best = x;
        }
        std::vector<Index> order(static_cast<std::size_t>(count));
        for (Index k = 0; k < count; ++k) order[static_cast<std::size_t>(k)] = k;
        std::ranges::sort(order, {}, [&](Index k) { return best(k); });
        const double sum = best.tail(count).squaredNorm();
        for (std::size_t k = 0; k < order.size(); ++k) {
            const double variance = std::exp(best(order[k])), one = 1;
            kernel.terms[k].scale[c] = best(count + order[k]) * best(count + order[k]) / sum;
            kernel.terms[k].lines[channel] = gaussianLine({&one, 1}, {&variance, 1});
            kernel.extent_mm = std::max(kernel.extent_mm, kernel.terms[k].lines[channel].extent());
        }
    }
    return kernel;
}

namespace {

// [dEonLuebke2007] Fig. 14-13. The weights of a channel add up to 1, which tells the copies with 0.366 for 0.336 in the
// second green weight, and 0.334 for 0.344 in the second blue one, from the published ones.
constexpr std::array<double, 6> skin6_variances{0.0064, 0.0484, 0.187, 0.567, 1.99, 7.41};
constexpr std::array<Rgb, 6> skin6_weights{{{0.233, 0.455, 0.649},
                                            {0.100, 0.336, 0.344},
                                            {0.118, 0.198, 0.000},
                                            {0.113, 0.007, 0.007},
                                            {0.358, 0.004, 0.000},
                                            {0.078, 0.000, 0.000}}};
// [Jimenez2009]'s demonstration: skin, whose narrowest term is not blurred, and marble.
constexpr std::array<double, 4> skin4_variances{0, 0.0516500425655, 0.271928080903, 2.00626388153};
constexpr std::array<Rgb, 4> skin4_weights{{{0.240516183695, 0.447403391891, 0.615796108321},
                                            {0.115857499765, 0.366176401412, 0.343917471552},
                                            {0.183619017698, 0.186420206697, 0.0},
                                            {0.460007298842, 0.0, 0.0402864201267}}};
constexpr std::array<double, 4> marble4_variances{0.0362208693441, 0.114450574559, 0.455584392509, 3.48331959682};
constexpr std::array<Rgb, 4> marble4_weights{{{0.0544578254963, 0.12454890956, 0.217724878147},
                                              {0.243663230592, 0.243532369381, 0.18904245481},
                                              {0.310530428621, 0.315816663292, 0.374244725886},
                                              {0.391348515291, 0.316102057768, 0.218987941157}}};
// [dEonLuebke2007] Fig. 14-12: marble's green channel, in all three.
constexpr std::array<double, 4> marble_green_variances{0.036, 0.14, 0.91, 7.0};
constexpr std::array<Rgb, 4> marble_green_weights{
    {{0.070, 0.070, 0.070}, {0.18, 0.18, 0.18}, {0.21, 0.21, 0.21}, {0.29, 0.29, 0.29}}};

}  // namespace

std::span<const GaussianPreset> gaussianPresets() {
    static constexpr std::array<GaussianPreset, 4> presets{{
        {"skin6", "d'Eon and Luebke 2007, Fig. 14-13", skin6_variances, skin6_weights},
        {"skin4", "Jimenez et al. 2009, demonstration", skin4_variances, skin4_weights},
        {"marble4", "Jimenez et al. 2009, demonstration", marble4_variances, marble4_weights},
        {"marble_green", "d'Eon and Luebke 2007, Fig. 14-12", marble_green_variances, marble_green_weights},
    }};
    return presets;
}

SeparableKernel presetGaussians(std::string_view name) {
    std::vector<std::string> names;
    for (const GaussianPreset& preset : gaussianPresets()) {
        names.emplace_back(preset.name);
        if (preset.name != name) continue;
        Rgb sum;
        for (const Rgb& weight : preset.weights) sum = sum + weight;
        SeparableKernel kernel{.method = "gaussians"};
        for (std::size_t k = 0; k < preset.weights.size(); ++k) {
            const double one = 1, variance = preset.variances_mm2[k];
            KernelTerm term{.scale = preset.weights[k] / sum};
            term.lines.fill(gaussianLine({&one, 1}, {&variance, 1}));
            kernel.extent_mm = std::max(kernel.extent_mm, term.lines[0].extent());
            kernel.terms.push_back(std::move(term));
        }
        return kernel;
    }
    throw unknownName(ErrorKind::usage, "set of Gaussians", name, names);
}

}  // namespace searchlight
