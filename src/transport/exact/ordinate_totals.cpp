// At k = 0 nothing varies with the azimuth but the beam, whose mean over azimuths is all that matters to totals. So
// directions are few whatever their cosines are.
#include "transport/exact/ordinate_totals.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>

#include "base/error.h"
#include "transport/exact/ordinate_problem.h"
#include "transport/exact/ordinate_slab.h"
#include "transport/exact/ordinate_stack.h"
#include "transport/slab/slab_entry.h"

namespace searchlight {

namespace {

constexpr int kCosines = 28, kFewer = 24;
constexpr double kSafety = 2, kRounding = 1e-9;

bool scatters(const SlabProblem& problem) {
    return std::ranges::any_of(problem.layers, [](const SlabLayer& layer) { return layer.sigma_s > 0; });
}

// Of light that entered, with so many cosines.
struct Level {
    StackTotals totals;
    SlabUnscattered beam;
};

Level solveLevel(const SlabProblem& problem, int cosines, int angles) {
    OrdinateStack stack =
        ordinateStack(problem, {.escaping = cosines, .alone = 0, .trapped = cosines, .narrow = cosines});
    const SlabUnscattered beam = addBeam(stack, straightWalk(problem, stack));
    return {stackTotals(stack, cosines, angles), beam};
}

// What is scattered into the peaks has gone on with the beam there; here it has not.
OrdinateStack wholeStack(const SlabProblem& problem) {
    OrdinateStack stack{problem.n_above, problem.n_below, {}};
    for (const SlabLayer& layer : problem.layers)
        stack.layers.push_back({.n = layer.n,
                                .sigma_t = layer.sigma_a + layer.sigma_s,
                                .sigma_s = layer.sigma_s,
                                .thickness = layer.thickness_mm});
    return stack;
}

// Nothing but the beam: Fresnel's equations, and Beer's law in each layer.
void addUnscattered(const SlabProblem& problem, const OrdinateStack& stack, const SlabUnscattered& beam, double entered,
                    SlabResult& result) {
    for (std::size_t i = 0; i < problem.layers.size(); ++i) {
        const OrdinateStack::Layer& layer = stack.layers[i];
        const double stays = layer.sigma_t > 0 ? -std::expm1(-layer.sigma_t * layer.thickness / layer.beam_cosine) : 0;
        result.A_layer.push_back({entered * stays * (layer.beam_down + layer.beam_up)});
        result.A.mean += result.A_layer.back().mean;
    }
    result.R_unscattered = {entered * beam.R};
    result.T_unscattered = {entered * beam.T};
}

SlabSeries perSolidAngle(const std::vector<double>& fine, const std::vector<double>& coarse, double entered) {
    SlabSeries series;
    const double step = 0.5 * std::numbers::pi / static_cast<double>(fine.size());
    for (std::size_t i = 0; i < fine.size(); ++i) {
        const double middle = (static_cast<double>(i) + 0.5) * step;
        const double solid = 4 * std::numbers::pi * std::sin(0.5 * step) * std::sin(middle);
        series.mean.push_back(entered * fine[i] / solid);
        // Differences change their sign from one angle to the next, which does not make them small.
        double largest = 0;
        for (std::size_t k = i > 0 ? i - 1 : 0; k < std::min(i + 2, fine.size()); ++k)
            if (fine[k] != 0) largest = std::max(largest, std::abs(coarse[k] / fine[k] - 1));
        series.standard_error.push_back(kSafety * largest * std::abs(series.mean.back()) + kRounding);
    }
    return series;
}

SlabResult solve(const SlabProblem& problem, int angles) {
    slabLayout(problem, {.edges_mm = {0, 1}, .angles = angles, .depth_mm = 1});
    if (const std::string reason = whyNotOrdinateTotals(problem); !reason.empty())
        throw inputError("no exact solution: " + reason, ordinateSlabsCovered());
    const SlabEntry entry = slabEntry(problem);
    const std::vector<double> none(static_cast<std::size_t>(angles));
    SlabResult result;
    result.specular = entry.specular;
    result.R_a = result.T_a = {none, none};
    if (entry.first == problem.layers.size() || entry.specular == 1) {
        result.A_layer.resize(problem.layers.size());
        result.T_unscattered = {1 - entry.specular};
        return result;
    }
    const double entered = 1 - entry.specular;
    OrdinateStack whole = wholeStack(problem);
    const SlabUnscattered beam = addBeam(whole, straightWalk(problem, whole));
    if (!scatters(problem)) {
        addUnscattered(problem, whole, beam, entered, result);
        return result;
    }
    const Level fine = solveLevel(problem, kCosines, angles), coarse = solveLevel(problem, kFewer, angles);
    // What layers that do not absorb keep is an error that all share.
    double kept = 0;
    for (std::size_t i = 0; i < problem.layers.size(); ++i)
        if (problem.layers[i].sigma_a == 0) kept += std::abs(fine.totals.absorbed[i]);
    const auto estimate = [&](double value, double other) {
        return Estimate{entered * value, entered * kSafety * (std::abs(value - other) + kept) + kRounding};
    };
    result.R_unscattered = {entered * beam.R};
    result.T_unscattered = {entered * beam.T};
    result.R = estimate(fine.totals.R + fine.beam.R - beam.R, coarse.totals.R + coarse.beam.R - beam.R);
    result.T = estimate(fine.totals.T + fine.beam.T - beam.T, coarse.totals.T + coarse.beam.T - beam.T);
    for (std::size_t i = 0; i < problem.layers.size(); ++i) {
        const bool absorbs = problem.layers[i].sigma_a > 0;
        result.A_layer.push_back(absorbs ? estimate(fine.totals.absorbed[i], coarse.totals.absorbed[i]) : Estimate{});
        result.A.mean += result.A_layer.back().mean;
        result.A.standard_error += result.A_layer.back().standard_error;
    }
    result.R_a = perSolidAngle(fine.totals.R_a, coarse.totals.R_a, entered);
    result.T_a = perSolidAngle(fine.totals.T_a, coarse.totals.T_a, entered);
    return result;
}

}  // namespace

std::string whyNotOrdinateTotals(const SlabProblem& problem) {
    double n_min = std::min(problem.n_above, problem.n_below), n_max = std::max(problem.n_above, problem.n_below);
    for (std::size_t i = 0; i < problem.layers.size(); ++i) {
        const SlabLayer& layer = problem.layers[i];
        const bool alone = problem.layers.size() == 1;
        const std::string name = alone ? "the layer" : fmt::format("layer {}", i + 1);
        n_min = std::min(n_min, layer.n);
        n_max = std::max(n_max, layer.n);
        if (layer.sigma_s == 0) continue;
        if (layer.phase) return name + " has a tabulated phase function";
        if (layer.thickness_mm == 0) return name + " has no thickness";
        if (!(std::abs(layer.g) <= kOrdinateLargestG))
            return fmt::format("|g| {}{} is above {}", std::abs(layer.g), alone ? "" : " of " + name,
                               kOrdinateLargestG);
        const double albedo = layer.sigma_s / (layer.sigma_a + layer.sigma_s);
        if (std::isinf(layer.thickness_mm) && !(albedo <= kOrdinateLargestAlbedo))
            return fmt::format("the albedo {}{} is above {}", albedo,
                               alone ? "" : fmt::format(" of {}, which has no end,", name), kOrdinateLargestAlbedo);
    }
    if (scatters(problem) && n_max > kOrdinateLargestRatio * n_min)
        return fmt::format("the refractive indices {} and {} differ by more than a factor of {}", n_min, n_max,
                           kOrdinateLargestRatio);
    return {};
}

SlabResult solveSlabTotals(const SlabProblem& problem, int angles) {
    const auto start = std::chrono::steady_clock::now();
    SlabResult result = solve(problem, angles);
    result.threads = 1;
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return result;
}

}  // namespace searchlight
