#include "transport/exact/ordinate_problem.h"

#include <cmath>

#include "transport/slab/slab_entry.h"

namespace searchlight {

namespace {

constexpr double kClearMfp = 1e30;  // as in slab.cpp

}  // namespace

OrdinateStack ordinateStack(const SlabProblem& problem, const StackCount& count) {
    OrdinateStack stack{problem.n_above, problem.n_below, {}};
    for (const SlabLayer& layer : problem.layers)
        stack.layers.push_back({.n = layer.n, .sigma_t = 1, .sigma_s = layer.sigma_s, .thickness = layer.thickness_mm});
    StackCount cosines = count;
    cosines.azimuths = 1;
    const std::vector<LayerRays> rays = stackRays(stack, cosines, 0);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const SlabLayer& layer = problem.layers[i];
        OrdinateStack::Layer& smooth = stack.layers[i];
        if (layer.sigma_s > 0) smooth.phase = smoothPhase(layer.g, static_cast<int>(2 * rays[i].size()) - 2);
        smooth.sigma_s = layer.sigma_s * (1 - smooth.phase.peak);
        smooth.sigma_t = layer.sigma_a + smooth.sigma_s;
    }
    return stack;
}

SlabWalk straightWalk(const SlabProblem& problem, const OrdinateStack& stack) {
    SlabWalk walk;
    for (std::size_t i = 0; i < stack.layers.size(); ++i) {
        const SlabLayer& layer = problem.layers[i];
        const double above = i == 0 ? problem.n_above : problem.layers[i - 1].n;
        const double beyond = i + 1 == stack.layers.size() ? problem.n_below : problem.layers[i + 1].n;
        const double sigma_t = stack.layers[i].sigma_t;
        // The phase function is put back as it is, with its peak, [Nakajima1988].
        walk.layers.push_back({.mfp_mm = layer.clear() ? kClearMfp : 1 / sigma_t,
                               .absorbed = layer.clear() ? 0 : 1 - layer.sigma_s / sigma_t,
                               .g = layer.g,
                               .thickness_mm = layer.thickness_mm,
                               .eta_up = layer.n / above,
                               .eta_down = std::isinf(layer.thickness_mm) ? 1 : layer.n / beyond});
    }
    const SlabEntry entry = slabEntry(problem);
    walk.first = static_cast<std::int32_t>(entry.first);
    walk.sin_beam = entry.sine;
    walk.cos_beam = std::sqrt((1 - entry.sine) * (1 + entry.sine));
    return walk;
}

SlabUnscattered addBeam(OrdinateStack& stack, const SlabWalk& walk) {
    SlabUnscattered beam = slabUnscattered(walk);
    for (std::size_t i = 0; i < stack.layers.size(); ++i) {
        OrdinateStack::Layer& layer = stack.layers[i];
        layer.beam_down = beam.down[i];
        layer.beam_up = beam.up[i];
        // Where no light gets there is no direction either.
        if (beam.cosine[i] > 0) layer.beam_cosine = beam.cosine[i];
    }
    return beam;
}

}  // namespace searchlight
