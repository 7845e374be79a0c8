#include "kernel/methods.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "kernel/optimised.h"
#include "kernel/preintegrated.h"
#include "kernel/singular.h"
#include "kernel/taps.h"

namespace searchlight {

std::span<const Method> methods() {
    static constexpr std::array<Method, 8> list{
        {{"preintegrated", "R_d integrated along one axis: exact for edges along the axes"},
         {"svd", "singular vectors: nearest of its rank in kernel space"},
         {"guided", "one line, nearest in kernel space under a guide function, with mass 1"},
         {"gaussians", "a sum of Gaussians, fitted or published"},
         {"manual", "two Gaussians on one line, near and far"},
         {"skin", "the first separable kernel, made for skin, bent by t and f"},
         {"optimised", "taps, offsets and weights together, for the least error of pictures"},
         {"turned", "the same for axes that turn from pixel to pixel: no cross, grain instead"}}};
    return list;
}

namespace {

void requireRank(int rank, int most) {
    if (rank < 1 || rank > most)
        throw usageError(fmt::format("rank {} is none of this method", rank), fmt::format("expected 1 to {}", most));
}

Taps tapsOf(const SeparableKernel& kernel, const MethodOptions& options) {
    if (options.placed) return placedTaps(kernel, options.taps);
    return quadraticTaps(kernel, options.taps, options.rest);
}

}  // namespace

TwoGaussians fittedTwoGaussians(const GroundTruth& truth) {
    const SeparableKernel gaussians = fittedGaussians(truth, 2, GaussianMeasure::pictures, 0);
    TwoGaussians fitted;
    double weight = 0;
    int channels = 0;
    for (int c = 0; c < Rgb::channels; ++c) {
        if (!truth.scatters(c)) continue;
        // The extent of a Gaussian's line is 6 sigma.
        fitted.near_mm[c] = gaussians.terms[0].lines[static_cast<std::size_t>(c)].extent() / 6;
        fitted.far_mm[c] = gaussians.terms[1].lines[static_cast<std::size_t>(c)].extent() / 6;
        weight += gaussians.terms[0].scale[c];
        ++channels;
    }
    fitted.near_weight = channels > 0 ? weight / channels : 1;
    return fitted;
}

MadeKernel makeKernel(const GroundTruth& truth, const CellKernel& cells, const MethodOptions& options) {
    if (options.taps < 3 || options.taps > 101 || options.taps % 2 == 0)
        throw usageError(fmt::format("{} taps are no kernel", options.taps), "expected an odd number from 3 to 101");
    MadeKernel made{.name = options.method};
    const std::string& method = options.method;
    if (method == "preintegrated") {
        made.kernel = preintegrated(truth);
    } else if (method == "svd") {
        requireRank(options.rank, 12);
        SingularKernel singular = singularKernel(cells, options.rank);
        made.name = fmt::format("svd {}", options.rank);
        made.kernel = std::move(singular.normalised);
        made.raw = std::move(singular.raw);
    } else if (method == "guided") {
        GuidedKernel guided = guidedKernel(cells, preintegrated(truth), options.guided);
        made.name = fmt::format("guided k={:g}", options.guided.k);
        made.kernel = std::move(guided.kernel);
        if (options.guided.soft > 0) {
            made.raw = made.kernel;
            for (KernelTerm& term : made.kernel->terms) term.scale = term.scale / guided.mass;
        }
    } else if (method == "gaussians") {
        if (options.preset.empty() && (options.count < 1 || options.count > most_gaussian_terms))
            throw usageError(fmt::format("{} Gaussians cannot be fitted", options.count),
                             fmt::format("expected 1 to {}", most_gaussian_terms));
        made.name = options.preset.empty() ? fmt::format("gaussians {}", options.count) : options.preset;
        made.kernel = options.preset.empty()
                          ? fittedGaussians(truth, options.count, options.measure, 2 * cells.edges[1])
                          : presetGaussians(options.preset);
    } else if (method == "manual") {
        made.kernel = twoGaussians(options.manual           ? *options.manual
                                   : options.preset.empty() ? fittedTwoGaussians(truth)
                                                            : twoGaussiansPreset(options.preset));
    } else if (method == "skin") {
        made.skin = options.skin ? *options.skin : fittedSkinModel(cells);
        made.kernel = skinModelKernel(*made.skin);
    } else if (method == "optimised") {
        requireRank(options.rank, 2);
        made.name = fmt::format("optimised {}", options.rank);
        made.taps = optimisedTaps(truth, {.taps = options.taps, .rank = options.rank}).taps;
        return made;
    } else if (method == "turned") {
        requireRank(options.rank, 1);
        made.taps = optimisedTaps(truth, {.taps = options.taps, .turned = true}).taps;
        return made;
    } else {
        std::vector<std::string> names;
        for (const Method& known : methods()) names.emplace_back(known.name);
        throw unknownName(ErrorKind::usage, "method", method, names);
    }
    made.taps = tapsOf(*made.kernel, options);
    return made;
}

SeparableKernel kernelOfTaps(const Taps& taps) {
    SeparableKernel kernel{.method = "taps"};
    for (const TapTerm& taken : taps.terms) {
        const std::size_t middle = taken.offsets_mm.size() / 2, last = taken.offsets_mm.size() - 1;
        KernelTerm term{.angle_deg = taken.angle_deg, .scale = taken.scale};
        std::vector<double> edges{0};
        for (std::size_t i = middle; i < last; ++i)
            edges.push_back(0.5 * (taken.offsets_mm[i] + taken.offsets_mm[i + 1]));
        edges.push_back(1.5 * taken.offsets_mm[last] - 0.5 * taken.offsets_mm[last - 1]);
        for (int c = 0; c < Rgb::channels; ++c) {
            std::vector<double> means;
            for (std::size_t i = middle; i <= last; ++i)
                means.push_back((i == middle ? 0.5 : 1) * taken.weights[i][c] /
                                (edges[i - middle + 1] - edges[i - middle]));
            term.lines[static_cast<std::size_t>(c)] = lineOfCells(edges, means, taken.delta[c]);
        }
        kernel.extent_mm = std::max(kernel.extent_mm, edges.back());
        kernel.terms.push_back(std::move(term));
    }
    return kernel;
}

}  // namespace searchlight
