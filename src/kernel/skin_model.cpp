#include "kernel/skin_model.h"

#include <cassert>
#include <cmath>
#include <numbers>

#include "kernel/gaussians.h"
#include "kernel/taps.h"

namespace searchlight {

namespace {

// Red of skin6 from its second Gaussian on, as the original program has it.
constexpr std::array<double, 5> weights{0.100, 0.118, 0.113, 0.358, 0.078};
constexpr std::array<double, 5> variances{0.0484, 0.187, 0.567, 1.99, 7.41};

double stretch(const SkinModel& model, int channel) { return (0.001 + model.falloff[channel]) / model.width; }

// p is a radial profile used along a line: a Gaussian of variance v, 1 / (2 pi v) high, has 1 / sqrt(v) of the mass.
LineKernel lineOf(double stretch_mm, double strength) {
    std::array<double, 6> mass{}, variance{};
    double sum = 0;
    for (std::size_t k = 0; k < weights.size(); ++k) sum += weights[k] / std::sqrt(variances[k]);
    for (std::size_t k = 0; k < weights.size(); ++k) {
        mass[k] = strength * weights[k] / std::sqrt(variances[k]) / sum;
        variance[k] = variances[k] * stretch_mm * stretch_mm;
    }
    mass[5] = 1 - strength;
    return gaussianLine(mass, variance);
}

double profile(double r) {
    double sum = 0;
    for (std::size_t k = 0; k < weights.size(); ++k)
        sum += weights[k] * std::exp(-r * r / (2 * variances[k])) / (2 * std::numbers::pi * variances[k]);
    return sum;
}

}  // namespace

SeparableKernel skinModelKernel(const SkinModel& model) {
    SeparableKernel kernel{.method = "skin", .terms = std::vector<KernelTerm>(1)};
    for (int c = 0; c < Rgb::channels; ++c) {
        LineKernel& line = kernel.terms[0].lines[static_cast<std::size_t>(c)];
        line = lineOf(stretch(model, c), model.strength[c]);
        kernel.extent_mm = std::max(kernel.extent_mm, line.extent());
    }
    return kernel;
}

SkinModel fittedSkinModel(const CellKernel& truth) {
    SkinModel model;
    const std::size_t n = truth.size();
    for (std::size_t c = 0; c < Rgb::channels; ++c) {
        // With a = t p + (1 - t) d the objective is a polynomial in t, whose coefficients are products on the grid.
        const auto dot = [&](const std::vector<double>& a, const std::vector<double>& b) {
            double sum = 0;
            for (std::size_t i = 0; i < n; ++i) sum += truth.width(i) * a[i] * b[i];
            return sum;
        };
        const std::vector<double> middle = cellsOfLine(LineKernel(), truth.edges);
        const auto within = [&](const std::vector<double>& a, const std::vector<double>& b) {
            double sum = 0;
            for (std::size_t j = 0; j < n; ++j) {
                if (b[j] == 0) continue;
                double of_row = 0;
                for (std::size_t i = 0; i < n; ++i) of_row += truth.width(i) * truth.mean[c][j * n + i] * a[i];
                sum += truth.width(j) * b[j] * of_row;
            }
            return sum;
        };
        const double dd = dot(middle, middle), Kdd = within(middle, middle);
        double least = 0;
        bool found = false;
        const double first = truth.edges[1] / 2, last = truth.edges.back() / 4;
        for (double f = first; f < last; f *= 1.05) {
            const std::vector<double> p = cellsOfLine(lineOf(f, 1), truth.edges);
            const double pp = dot(p, p), pd = dot(p, middle), Kpp = within(p, p), Kpd = within(p, middle);
            for (int step = 0; step <= 200; ++step) {
                const double t = step / 200.0, u = 1 - t;
                const double square = t * t * pp + 2 * t * u * pd + u * u * dd;
                const double value = square * square - 2 * (t * t * Kpp + 2 * t * u * Kpd + u * u * Kdd);
                if (found && value >= least) continue;
                found = true;
                least = value;
                model.strength[static_cast<int>(c)] = t;
                model.falloff[static_cast<int>(c)] = f - 0.001;
            }
        }
    }
    return model;
}

Taps originalTaps(const SkinModel& model, int count) {
    assert(count >= 3 && count % 2 == 1);
    const std::vector<double> offsets = quadraticOffsets(count, count > 20 ? 3 : 2);
    const std::size_t n = offsets.size();
    TapTerm term{.offsets_mm = offsets, .weights = std::vector<Rgb>(n)};
    for (int c = 0; c < Rgb::channels; ++c) {
        double sum = 0;
        for (std::size_t i = 0; i < n; ++i) {
            const double before = i > 0 ? offsets[i] - offsets[i - 1] : 0;
            const double after = i + 1 < n ? offsets[i + 1] - offsets[i] : 0;
            term.weights[i][c] = 0.5 * (before + after) * profile(offsets[i] / stretch(model, c));
            sum += term.weights[i][c];
        }
        for (Rgb& weight : term.weights) weight[c] *= model.strength[c] / sum;
        term.delta[c] = 1 - model.strength[c];
    }
    return {.terms = {std::move(term)}, .extent_mm = offsets.back()};
}

}  // namespace searchlight
