// One chunk of the best estimator of slabs: all its kinds of walks, and what they know together.
#include <cmath>
#include <cstdint>
#include <vector>

#include "transport/slab/slab_best.h"
#include "transport/slab/slab_best_flux.h"

namespace searchlight {

namespace {

constexpr std::uint64_t kBesideStream = 0x626573696465, kLedStream = 0x6C6564;

// Of what all walks together found.
void completeTotals(const SlabBestPlan& plan, double n, std::vector<double>& flux) {
    const SlabLayout& layout = plan.layout;
    const auto sum = [&](SlabLayout::Run whole, SlabLayout::Run one, SlabLayout::Run more) {
        for (std::size_t i = 0; i < layout.size(whole); ++i)
            flux[layout.first(whole) + i] = flux[layout.first(one) + i] + flux[layout.first(more) + i];
    };
    sum(SlabLayout::R_r, SlabLayout::R_r_single, SlabLayout::R_r_multiple);
    // What is not absorbed has left.
    double& R = flux[layout.first(SlabLayout::R_scattered)];
    double& T = flux[layout.first(SlabLayout::T_scattered)];
    double& A = flux[layout.first(SlabLayout::A_total)];
    const double missing =
        n - R - T - A - flux[layout.first(SlabLayout::R_unscattered)] - flux[layout.first(SlabLayout::T_unscattered)];
    R += plan.missing[0] * missing;
    T += plan.missing[1] * missing;
    A += plan.missing[2] * missing;
    if (plan.walk.layers.size() == 1) flux[layout.first(SlabLayout::A_layer)] = A;
    flux[layout.first(SlabLayout::R_multiple)] =
        flux[layout.first(SlabLayout::R_scattered)] - flux[layout.first(SlabLayout::R_single)];
}

// What walks that are led through the slab know better.
std::uint64_t addLed(const SlabBestPlan& plan, std::uint64_t seed, std::uint64_t chunk, double n,
                     std::vector<double>& flux) {
    const auto count = static_cast<std::uint64_t>(std::ceil(n * plan.lead->share));
    const double led = static_cast<double>(count);
    SlabBestSums found = walkForeseeingSlabChunk(plan, streamOf(seed ^ kLedStream, chunk), count, &*plan.lead);
    addKnown(plan, led, found);
    const std::vector<double> theirs = fluxOf(plan, found, led, {});
    for (std::size_t slot = 0; slot < flux.size(); ++slot) {
        const double part = plan.lead->part[slot];
        flux[slot] = part * (n / led) * theirs[slot] + (1 - part) * flux[slot];
    }
    return found.collisions;
}

// Analogue walks alone, as many of them with controls as the plan says.
std::uint64_t walkAlone(const SlabBestPlan& plan, std::uint64_t seed, std::uint64_t chunk, std::uint64_t walks,
                        std::vector<double>& flux) {
    const SlabLayout& layout = plan.layout;
    const auto count = static_cast<std::uint64_t>(std::ceil(static_cast<double>(walks) * plan.controlled));
    std::vector<double> sums(SlabControl::kSums * plan.control.layers.size());
    SlabTally told(layout), others(layout);
    std::uint64_t collisions = walkSlabChunk(plan.walk, seed, chunk, count, told, plan.control, sums);
    flux = told.pack();
    plan.pilot.correct(plan.control, sums, static_cast<double>(count), layout, flux);
    if (count == walks) return collisions;
    collisions += walkSlabChunk(plan.walk, seed ^ kBesideStream, chunk, walks - count, others);
    plan.pilot.join(plan.control, static_cast<double>(count), others.pack(), static_cast<double>(walks - count), layout,
                    flux);
    return collisions;
}

// Walks that foresee, and analogue ones beside them.
std::uint64_t walkMix(const SlabBestPlan& plan, std::uint64_t seed, std::uint64_t chunk, std::uint64_t walks,
                      std::vector<double>& flux) {
    const SlabLayout& layout = plan.layout;
    const SlabMix& mix = plan.mix;
    const double n = static_cast<double>(walks);
    const auto count = static_cast<std::uint64_t>(std::ceil(n * mix.beside));
    std::vector<double> sums(SlabControl::kSums * plan.control.layers.size());
    std::uint64_t collisions = 0;
    if (mix.places) {
        SlabTally beside(layout);
        collisions = walkSlabChunk(plan.walk, seed ^ kBesideStream, chunk, count, beside, plan.control, sums);
        flux = beside.pack();
    } else {
        SlabTally beside(plan.pilot.layout);
        collisions =
            walkSlabDepthsChunk(plan.walk, seed ^ kBesideStream, chunk, count, beside, plan.control, sums, plan.depths);
        flux = plan.pilot.spread(beside.flux(), layout);
    }
    plan.pilot.correct(plan.control, sums, static_cast<double>(count), layout, flux);
    SlabBestSums found = walkForeseeingSlabChunk(plan, streamOf(seed, chunk), walks);
    addKnown(plan, n, found);
    for (double& value : flux) value *= n / static_cast<double>(count);
    const std::vector<double> mine = fluxOf(plan, found, n, flux);
    for (std::size_t slot = 0; slot < flux.size(); ++slot)
        flux[slot] = mix.part[slot] * flux[slot] + (1 - mix.part[slot]) * mine[slot];
    return collisions + found.collisions;
}

}  // namespace

std::uint64_t walkSlabBestChunk(const SlabBestPlan& plan, std::uint64_t seed, std::uint64_t chunk, std::uint64_t walks,
                                SlabTally& tally) {
    const double n = static_cast<double>(walks);
    std::vector<double> flux;
    std::uint64_t collisions = (plan.mix.foresees ? walkMix : walkAlone)(plan, seed, chunk, walks, flux);
    if (plan.lead) collisions += addLed(plan, seed, chunk, n, flux);
    completeTotals(plan, n, flux);
    tally.unpack(flux);
    return collisions;
}

}  // namespace searchlight
