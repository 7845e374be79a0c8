#include "kernel/optimised.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "kernel/preintegrated.h"
#include "kernel/spectrum.h"
#include "kernel/taps.h"

namespace searchlight {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// A frequency that counts, and what the kernel should do there.
struct Probe {
    double x = 0, y = 0, root_power = 0;
    Rgb target;
};

// Taps of all terms as numbers without bounds. Offsets are exponentials. Weights of a pair are either squares over
// their sum, so that they are positive and add up to 1, or themselves, where the middle one is what is missing.
struct Layout {
    std::size_t terms = 1, side = 8;
    bool positive = true;
    bool line = false;    // probes are frequencies of the line alone
    bool turned = false;  // lines stand for their mean over all angles: waves become Bessel functions
    std::vector<double> angle_deg;
    std::vector<Rgb> sum;  // of each term's weights, delta included; where weights are themselves
    std::vector<Rgb> delta;

    std::size_t offset(std::size_t t, std::size_t k) const { return t * side + k; }
    std::size_t weight(std::size_t c, std::size_t t, std::size_t k) const {
        return terms * side + (c * terms + t) * (side + 1) + k;
    }
    std::size_t share(std::size_t c) const { return terms * side + 3 * terms * (side + 1) + c; }
    std::size_t size() const { return share(3); }
};

class Search {
public:
    Search(Layout layout, std::vector<Probe> probes) : layout_(std::move(layout)), probes_(std::move(probes)) {}

    // Sum of squares; with `step` also the damped step that should make it smaller.
    double objective(const VectorXd& x, VectorXd* gradient = nullptr, MatrixXd* normal = nullptr) const {
        const std::size_t n = layout_.side, T = layout_.terms;
        if (gradient) {
            *gradient = VectorXd::Zero(static_cast<Index>(layout_.size()));
            *normal = MatrixXd::Zero(static_cast<Index>(layout_.size()), static_cast<Index>(layout_.size()));
        }
        const auto F = static_cast<Index>(probes_.size());
        // cos and sin of frequency times offset along both axes of each term.
        std::vector<MatrixXd> cosine(2 * T), sine(2 * T);
        for (std::size_t t = 0; t < T; ++t) {
            const double angle = layout_.angle_deg[t] * std::numbers::pi / 180;
            for (std::size_t axis = 0; axis < 2; ++axis) {
                MatrixXd& cos = cosine[2 * t + axis] = MatrixXd::Ones(F, static_cast<Index>(n + 1));
                MatrixXd& sin = sine[2 * t + axis] = MatrixXd::Zero(F, static_cast<Index>(n + 1));
                if (layout_.line && axis == 1) continue;
                if (layout_.turned && axis == 1) {
                    cos = cosine[2 * t];
                    sin = sine[2 * t];
                    continue;
                }
                const double ax = axis == 0 ? std::cos(angle) : -std::sin(angle);
                const double ay = axis == 0 ? std::sin(angle) : std::cos(angle);
                for (std::size_t k = 1; k <= n; ++k) {
                    const double offset = std::exp(x(static_cast<Index>(layout_.offset(t, k - 1))));
                    for (Index f = 0; f < F; ++f) {
                        const Probe& probe = probes_[static_cast<std::size_t>(f)];
                        const double phase = offset * (layout_.turned ? probe.x : ax * probe.x + ay * probe.y);
                        cos(f, static_cast<Index>(k)) = layout_.turned ? ::j0(phase) : std::cos(phase);
                        if (gradient)
                            sin(f, static_cast<Index>(k)) = phase * (layout_.turned ? ::j1(phase) : std::sin(phase));
                    }
                }
            }
        }
        VectorXd root(F);
        for (Index f = 0; f < F; ++f) root(f) = probes_[static_cast<std::size_t>(f)].root_power;
        double sum = 0;
        const std::size_t active = T * n + T * (n + 1) + 1;
        for (std::size_t c = 0; c < Rgb::channels; ++c) {
            std::vector<VectorXd> weights, factor(2 * T);
            VectorXd residual(F);
            for (Index f = 0; f < F; ++f)
                residual(f) = -probes_[static_cast<std::size_t>(f)].target[static_cast<int>(c)];
            for (std::size_t t = 0; t < T; ++t) {
                weights.push_back(weightsOf(x, c, t));
                for (std::size_t axis = 0; axis < 2; ++axis) {
                    factor[2 * t + axis] = cosine[2 * t + axis] * weights[t];
                    if (!layout_.positive) factor[2 * t + axis].array() += layout_.delta[t][static_cast<int>(c)];
                }
                if (layout_.line) factor[2 * t + 1].setOnes();
                residual += shareOf(x, c, t) * factor[2 * t].cwiseProduct(factor[2 * t + 1]);
            }
            residual = residual.cwiseProduct(root);
            sum += residual.squaredNorm();
            if (!gradient) continue;

            MatrixXd slopes = MatrixXd::Zero(F, static_cast<Index>(active));
            std::vector<std::size_t> where(active);
            for (std::size_t t = 0; t < T; ++t)
                for (std::size_t axis = 0; axis < (layout_.line ? 1u : 2u); ++axis) {
                    const VectorXd other = shareOf(x, c, t) * factor[2 * t + 1 - axis].cwiseProduct(root);
                    for (std::size_t k = 0; k < n; ++k) {
                        slopes.col(static_cast<Index>(t * n + k)) -=
                            weights[t](static_cast<Index>(k + 1)) *
                            other.cwiseProduct(sine[2 * t + axis].col(static_cast<Index>(k + 1)));
                        where[t * n + k] = layout_.offset(t, k);
                    }
                    for (std::size_t k = 0; k <= n; ++k) {
                        const auto column = static_cast<Index>(T * n + t * (n + 1) + k);
                        const auto at = static_cast<Index>(layout_.weight(c, t, k));
                        where[static_cast<std::size_t>(column)] = static_cast<std::size_t>(at);
                        const VectorXd cos = cosine[2 * t + axis].col(static_cast<Index>(k));
                        if (layout_.positive)
                            slopes.col(column) +=
                                (2 * x(at) / squares(x, c, t)) * other.cwiseProduct(cos - factor[2 * t + axis]);
                        else if (k > 0)
                            slopes.col(column) += other.cwiseProduct((cos.array() - 1).matrix());
                    }
                }
            where[active - 1] = layout_.share(c);
            if (T == 2)
                slopes.col(static_cast<Index>(active - 1)) =
                    (factor[0].cwiseProduct(factor[1]) - factor[2].cwiseProduct(factor[3])).cwiseProduct(root);
            const MatrixXd product = slopes.transpose() * slopes;
            const VectorXd down = slopes.transpose() * residual;
            for (std::size_t i = 0; i < active; ++i) {
                (*gradient)(static_cast<Index>(where[i])) += down(static_cast<Index>(i));
                for (std::size_t j = 0; j < active; ++j)
                    (*normal)(static_cast<Index>(where[i]), static_cast<Index>(where[j])) +=
                        product(static_cast<Index>(i), static_cast<Index>(j));
            }
        }
        return sum;
    }

    // From x, in place: Levenberg and Marquardt. Returns the number of steps.
    int run(VectorXd& x, double& value, int max_steps) const {
        VectorXd gradient;
        MatrixXd normal;
        double damping = 1e-2;
        int step = 0;
        for (; step < max_steps; ++step) {
            value = objective(x, &gradient, &normal);
            const double floor = 1e-12 * normal.diagonal().maxCoeff();
            bool better = false;
            double gained = 0;
            while (!better && damping < 1e8) {
                MatrixXd damped = normal;
                damped.diagonal() += damping * normal.diagonal() + VectorXd::Constant(x.size(), floor);
                // Longer steps would make an offset e times as large at once.
                const VectorXd next = x - damped.ldlt().solve(gradient).cwiseMax(-1).cwiseMin(1);
                const double after = objective(next);
                better = after < value;
                if (better) {
                    gained = value - after;
                    x = next;
                    value = after;
                }
                damping *= better ? 0.2 : 5;
            }
            if (!better || gained < 1e-4 * value) break;
        }
        return step;
    }

    VectorXd weightsOf(const VectorXd& x, std::size_t c, std::size_t t) const {
        const std::size_t n = layout_.side;
        VectorXd weights(static_cast<Index>(n + 1));
        for (std::size_t k = 0; k <= n; ++k)
            weights(static_cast<Index>(k)) = x(static_cast<Index>(layout_.weight(c, t, k)));
        if (layout_.positive) return weights.cwiseAbs2() / squares(x, c, t);
        const int channel = static_cast<int>(c);
        weights(0) = layout_.sum[t][channel] - layout_.delta[t][channel] - weights.tail(static_cast<Index>(n)).sum();
        return weights;
    }

    double shareOf(const VectorXd& x, std::size_t c, std::size_t t) const {
        if (layout_.terms == 1) return 1;
        const double share = x(static_cast<Index>(layout_.share(c)));
        return t == 0 ? share : 1 - share;
    }

    Taps taps(const VectorXd& x) const {
        Taps result;
        const std::size_t n = layout_.side;
        for (std::size_t t = 0; t < layout_.terms; ++t) {
            std::vector<std::size_t> order(n);
            for (std::size_t k = 0; k < n; ++k) order[k] = k;
            std::ranges::sort(order, {}, [&](std::size_t k) { return x(static_cast<Index>(layout_.offset(t, k))); });
            TapTerm term{.angle_deg = layout_.angle_deg[t],
                         .offsets_mm = std::vector<double>(2 * n + 1),
                         .weights = std::vector<Rgb>(2 * n + 1)};
            for (std::size_t k = 0; k < n; ++k) {
                const double offset = std::exp(x(static_cast<Index>(layout_.offset(t, order[k]))));
                term.offsets_mm[n + 1 + k] = offset;
                term.offsets_mm[n - 1 - k] = -offset;
                result.extent_mm = std::max(result.extent_mm, offset);
            }
            for (std::size_t c = 0; c < Rgb::channels; ++c) {
                const int channel = static_cast<int>(c);
                const VectorXd weights = weightsOf(x, c, t);
                term.weights[n][channel] = weights(0);
                for (std::size_t k = 0; k < n; ++k)
                    term.weights[n + 1 + k][channel] = term.weights[n - 1 - k][channel] =
                        0.5 * weights(static_cast<Index>(order[k] + 1));
                term.scale[channel] = shareOf(x, c, t);
            }
            if (!layout_.positive) term.delta = layout_.delta[t];
            result.terms.push_back(std::move(term));
        }
        return result;
    }

private:
    double squares(const VectorXd& x, std::size_t c, std::size_t t) const {
        double sum = 0;
        for (std::size_t k = 0; k <= layout_.side; ++k) {
            const double value = x(static_cast<Index>(layout_.weight(c, t, k)));
            sum += value * value;
        }
        return sum;
    }

    Layout layout_;
    std::vector<Probe> probes_;
};

// Half-energy radii of the narrowest, the middle and the widest channel; 0: none scatters.
struct Span {
    double narrow = 0, middle = 0, wide = 0;
};

Span spanOf(const GroundTruth& truth) {
    std::vector<double> radii;
    for (int c = 0; c < Rgb::channels; ++c)
        if (truth.scatters(c)) radii.push_back(truth.radiusOf(0.5, c));
    std::ranges::sort(radii);
    return radii.empty() ? Span{} : Span{radii.front(), radii[radii.size() / 2], radii.back()};
}

// Frequencies from those that see the kernel as a point to those of details a twentieth of the narrowest channel's
// radius.
constexpr int per_octave = 4;
constexpr double lowest = 0.05, highest = 20;

// What is built stands upright: of its edges so many more lie along the axes of the picture [Torralba2003], as part of
// all others. Left out, the taps err by a quarter more on an upright edge than those of the line do, which are exact
// for it.
constexpr double upright = 0.25;

// Power of edges in all directions falls as omega^-3, below one edge per `feature` no more; the circle's omega and
// d omega = omega d ln omega make it 1 / omega. Root of the sum: a smooth corner.
double powerOf(double omega, double feature) {
    const double corner = 2 * std::numbers::pi / feature;
    return omega * omega / std::pow(omega * omega + corner * corner, 1.5);
}

std::vector<Probe> planeProbes(const GroundTruth& truth, const std::array<LineKernel, Rgb::channels>& lines,
                               const Span& span, double feature, bool turned) {
    std::vector<Probe> probes;
    const int directions = turned ? 1 : 6;  // of an octant: 0 to 45 degrees, in the middle of equal parts
    for (double omega = lowest / span.wide; omega < highest / span.narrow; omega *= std::exp2(1.0 / per_octave)) {
        Rgb target;
        for (int c = 0; c < Rgb::channels; ++c)
            target[c] = truth.scatters(c) ? lines[static_cast<std::size_t>(c)].transform(omega) : 1;
        for (int i = 0; i < directions; ++i) {
            const double angle = turned ? 0 : (i + 0.5) / directions * std::numbers::pi / 4;
            probes.push_back({omega * std::cos(angle), omega * std::sin(angle),
                              std::sqrt(powerOf(omega, feature) / directions), target});
        }
        if (!turned) probes.push_back({omega, 0, std::sqrt(upright * powerOf(omega, feature)), target});
    }
    return probes;
}

// The numbers that stand for given taps.
VectorXd numbersOf(const Layout& layout, const Taps& taps) {
    VectorXd x = VectorXd::Zero(static_cast<Index>(layout.size()));
    for (std::size_t t = 0; t < layout.terms; ++t) {
        const TapTerm& term = taps.terms[t];
        for (std::size_t k = 0; k < layout.side; ++k)
            x(static_cast<Index>(layout.offset(t, k))) = std::log(term.offsets_mm[layout.side + 1 + k]);
        for (std::size_t c = 0; c < Rgb::channels; ++c)
            for (std::size_t k = 0; k <= layout.side; ++k) {
                const int channel = static_cast<int>(c);
                const double pair = (k == 0 ? 1 : 2) * term.weights[layout.side + k][channel] +
                                    (k == 0 && layout.positive ? term.delta[channel] : 0);
                // A weight of 0 has no slope as a square.
                x(static_cast<Index>(layout.weight(c, t, k))) =
                    layout.positive ? std::sqrt(std::max(pair, 1e-6)) : pair;
            }
    }
    for (std::size_t c = 0; c < Rgb::channels; ++c) x(static_cast<Index>(layout.share(c))) = 0.5;
    return x;
}

}  // namespace

OptimisedTaps optimisedTaps(const GroundTruth& truth, const OptimisedOptions& options) {
    const SeparableKernel line = preintegrated(truth);
    const Span span = spanOf(truth);
    OptimisedTaps best;
    if (span.wide == 0) {
        best.taps = sampleTaps(line, quadraticOffsets(options.taps, 1));
        return best;
    }
    Layout layout{.terms = static_cast<std::size_t>(options.rank), .side = static_cast<std::size_t>(options.taps / 2)};
    layout.angle_deg = {0, 45};
    layout.turned = options.turned;
    const double feature = options.feature_mm > 0 ? options.feature_mm : 16 * span.middle;
    const Search search(layout, planeProbes(truth, line.terms[0].lines, span, feature, options.turned));
    VectorXd numbers;
    std::vector<Taps> starts{placedTaps(line, options.taps)};
    for (const double rest : {0.1, 0.03, 0.01}) starts.push_back(quadraticTaps(line, options.taps, rest));
    for (Taps& start : starts) {
        if (options.rank == 2) {
            start.terms.push_back(start.terms[0]);
            start.terms[1].angle_deg = 45;
        }
        VectorXd x = numbersOf(layout, start);
        OptimisedTaps found{.start = search.objective(x)};
        found.steps = search.run(x, found.error, options.max_steps / 8);
        if (numbers.size() > 0 && found.error >= best.error) continue;
        best = std::move(found);
        numbers = x;
    }
    best.steps += search.run(numbers, best.error, options.max_steps);
    best.taps = search.taps(numbers);
    best.taps.turned = options.turned;
    return best;
}

Taps placedTaps(const SeparableKernel& kernel, int taps) {
    const std::vector<double> even = quadraticOffsets(taps, tapExtent(kernel));
    const Taps quadratic = sampleTaps(kernel, even);
    Taps result;
    for (std::size_t t = 0; t < kernel.terms.size(); ++t) {
        const KernelTerm& term = kernel.terms[t];
        // Scales of the lines: where half of their mass lies.
        const SeparableKernel alone{.terms = {term}};
        const double wide = tapExtent(alone, 0.5);
        Layout layout{.side = static_cast<std::size_t>(taps / 2), .positive = false, .line = true};
        layout.angle_deg = {0};
        Rgb sum, delta;
        for (int c = 0; c < Rgb::channels; ++c) {
            sum[c] = term.lines[static_cast<std::size_t>(c)].mass();
            delta[c] = term.lines[static_cast<std::size_t>(c)].delta();
        }
        layout.sum = {sum};
        layout.delta = {delta};
        std::vector<Probe> probes;
        for (double omega = lowest / wide; omega < 4 * highest / wide; omega *= std::exp2(0.5 / per_octave)) {
            // In one dimension an edge's power falls as the square of the frequency, and omega is all of its measure.
            Probe probe{.x = omega, .root_power = std::sqrt(powerOf(omega, 16 * wide))};
            for (int c = 0; c < Rgb::channels; ++c)
                probe.target[c] = term.lines[static_cast<std::size_t>(c)].transform(omega);
            probes.push_back(probe);
        }
        const Search search(layout, std::move(probes));
        double best = 0;
        TapTerm placed;
        for (const double rest : {0.1, 0.03, 0.01}) {
            VectorXd x = numbersOf(layout, sampleTaps(alone, quadraticOffsets(taps, tapExtent(alone, rest))));
            double error = 0;
            search.run(x, error, 40);
            if (!placed.weights.empty() && error >= best) continue;
            best = error;
            placed = search.taps(x).terms[0];
        }
        placed.angle_deg = term.angle_deg;
        placed.scale = term.scale;
        result.extent_mm = std::max(result.extent_mm, placed.offsets_mm.back());
        result.terms.push_back(std::move(placed));
    }
    return result;
}

}  // namespace searchlight
