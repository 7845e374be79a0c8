// What the best estimator of slabs decides before it walks: how its time is divided between the walks that foresee
// where light leaves and analogue walks beside them.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "transport/slab/slab_best.h"

namespace searchlight {

namespace {

// As in half_space_plan.cpp.
constexpr double kMostForesight = 0.7;

// The pilot has numbers of its own, the same for every seed.
constexpr std::uint64_t kPilotSeed = 0x736C6162, kBesideStream = 0x626573696465;
constexpr std::uint64_t kPilotChunks = 16, kPilotWalks = 128, kPilotAnalogue = 512;
constexpr double kStepTime = 9, kStart = 10, kAnalogueStepTime = 3, kAnalogueStart = 10;  // ns

// The part of the time for analogue walks: absorption and angles are known from them alone.
constexpr double kPartBeside = 0.5;

double sumOf(const std::vector<double>& list) { return std::accumulate(list.begin(), list.end(), 0.0); }

// Adds what is known and what the walks that foresee found to the slots of the layout.
void add(const SlabBestPlan& plan, SlabBestSums found, double walks, std::vector<double>& flux) {
    if (plan.single) {
        for (std::size_t row = 0; row < plan.layout.rows(); ++row) {
            found.single[row] += walks * plan.single->reflected[row];
            found.transmitted[row] += walks * plan.single->transmitted[row];
        }
        found.R_unscattered = walks * plan.single->R_unscattered;
        found.T_unscattered = walks * plan.single->T_unscattered;
    }
    const auto at = [&](SlabLayout::Run run, std::size_t i = 0) -> double& { return flux[plan.layout.first(run) + i]; };
    at(SlabLayout::R_single) += sumOf(found.single);
    at(SlabLayout::R_multiple) += sumOf(found.multiple);
    at(SlabLayout::R_scattered) += sumOf(found.single) + sumOf(found.multiple);
    at(SlabLayout::T_scattered) += sumOf(found.transmitted);
    at(SlabLayout::R_unscattered) += found.R_unscattered;
    at(SlabLayout::T_unscattered) += found.T_unscattered;
    for (std::size_t row = 0; row < plan.layout.rows(); ++row) {
        at(SlabLayout::R_r_single, row) += found.single[row];
        at(SlabLayout::R_r_multiple, row) += found.multiple[row];
        at(SlabLayout::R_r, row) += found.single[row] + found.multiple[row];
        at(SlabLayout::T_r, row) += found.transmitted[row];
    }
}

}  // namespace

bool bestServes(const SlabWalk& walk) {
    // What is clear has a free path longer than anything.
    const bool clear = std::ranges::any_of(walk.layers, [](const SlabWalk::Layer& l) { return l.mfp_mm > 1e20; });
    return walk.tables.stay.empty() && !clear;
}

SlabBestPlan::SlabBestPlan(const SlabWalk& slab, std::span<const double> edges, const SlabLayout& tallied)
    : walk(slab), layout(tallied), bins(laneBins(edges)), importance(makeSlabImportance(slab, edges)) {
    for (const SlabWalk::Layer& layer : slab.layers) {
        foresees.push_back(layer.g <= kMostForesight);
        absorbs |= layer.absorbed > 0;
    }
    if (slab.sin_beam == 0 && slab.shape.kind == BeamShape::pencil) single = slabSingle(slab, edges, foresees);

    BatchRatios best(layout.slots());
    std::uint64_t steps = 0, analogue_steps = 0;
    for (std::uint64_t chunk = 0; chunk < kPilotChunks; ++chunk) {
        const SlabBestSums found = walkForeseeingSlabChunk(*this, streamOf(kPilotSeed, chunk), kPilotWalks);
        steps += found.steps;
        std::vector<double> flux(layout.slots());
        add(*this, found, kPilotWalks, flux);
        best.add(flux, kPilotWalks);
    }
    SlabTally tally(layout);
    analogue_steps += walkSlabChunk(slab, kPilotSeed, kPilotChunks, kPilotAnalogue, tally);
    constexpr std::uint64_t walks = kPilotChunks * kPilotWalks;
    const double time = kStart + kStepTime * static_cast<double>(steps) / walks;
    const double analogue_time =
        kAnalogueStart + kAnalogueStepTime * static_cast<double>(analogue_steps) / kPilotAnalogue;
    beside = time / analogue_time;  // in equal times
    // The part that makes the relative variance of the mix least, of slots together. What the analogue walk counts has
    // the variance of counts.
    const auto part = [&](const std::vector<std::size_t>& slots) {
        double variance = 0, beside_variance = 0;
        for (const std::size_t slot : slots) {
            const Estimate flux = best.estimate(slot, walks);
            if (flux.mean <= 0) continue;
            variance += std::pow(flux.standard_error / flux.mean, 2);
            beside_variance += (1 - std::min(flux.mean, 0.99)) / (flux.mean * beside * walks);
        }
        return variance > 0 ? variance / (variance + beside_variance) : 0;
    };
    const auto annuli = [&](SlabLayout::Run run) {
        std::vector<std::size_t> slots(layout.rows() - 2);
        std::iota(slots.begin(), slots.end(), layout.first(run) + 1);
        return slots;
    };
    if (part(annuli(SlabLayout::R_r)) > 0.5) return;
    worthwhile = true;
    beside *= kPartBeside / (1 - kPartBeside);
    part_totals = part({layout.first(SlabLayout::R_scattered), layout.first(SlabLayout::T_scattered)});
    part_R_r = part(annuli(SlabLayout::R_r));
    part_T_r = part(annuli(SlabLayout::T_r));
}

std::uint64_t walkSlabBestChunk(const SlabBestPlan& plan, std::uint64_t seed, std::uint64_t chunk, std::uint64_t walks,
                                SlabTally& tally) {
    const SlabLayout& layout = plan.layout;
    const SlabBestSums found = walkForeseeingSlabChunk(plan, streamOf(seed, chunk), walks);
    const double n = static_cast<double>(walks);
    const auto count = static_cast<std::uint64_t>(std::ceil(n * plan.beside));
    SlabTally beside(layout);
    const std::uint64_t collisions = walkSlabChunk(plan.walk, seed ^ kBesideStream, chunk, count, beside);
    std::vector<double> mine(layout.slots());
    add(plan, found, n, mine);
    std::vector<double> flux(beside.flux().begin(), beside.flux().end());
    for (double& value : flux) value *= n / static_cast<double>(count);
    const auto mix = [&](SlabLayout::Run run, double part) {
        for (std::size_t slot = layout.first(run); slot < layout.first(run) + layout.size(run); ++slot)
            flux[slot] = part * flux[slot] + (1 - part) * mine[slot];
    };
    // What analogue walks say of order 1 is of no use where nearly all of it is known, and of nothing where all is.
    const bool mixes_single = !plan.single || std::ranges::count(plan.foresees, 0) > 0;
    const double part_unscattered = plan.single ? 0 : plan.part_totals;
    mix(SlabLayout::R_unscattered, part_unscattered);
    mix(SlabLayout::T_unscattered, part_unscattered);
    mix(SlabLayout::R_single, mixes_single ? plan.part_totals : 0);
    mix(SlabLayout::R_multiple, plan.part_totals);
    mix(SlabLayout::T_scattered, plan.part_totals);
    mix(SlabLayout::R_r_single, mixes_single ? plan.part_R_r : 0);
    mix(SlabLayout::R_r_multiple, plan.part_R_r);
    const auto sum = [&](SlabLayout::Run whole, SlabLayout::Run one, SlabLayout::Run more) {
        for (std::size_t i = 0; i < layout.size(whole); ++i)
            flux[layout.first(whole) + i] = flux[layout.first(one) + i] + flux[layout.first(more) + i];
    };
    sum(SlabLayout::R_scattered, SlabLayout::R_single, SlabLayout::R_multiple);
    sum(SlabLayout::R_r, SlabLayout::R_r_single, SlabLayout::R_r_multiple);
    mix(SlabLayout::T_r, plan.part_T_r);
    // What is not absorbed has left.
    if (plan.absorbs) {
        double left = 0;
        for (const SlabLayout::Run run :
             {SlabLayout::R_scattered, SlabLayout::R_unscattered, SlabLayout::T_scattered, SlabLayout::T_unscattered})
            left += flux[layout.first(run)];
        flux[layout.first(SlabLayout::A_total)] = n - left;
        if (plan.walk.layers.size() == 1) flux[layout.first(SlabLayout::A_layer)] = n - left;
    }
    tally.unpack(flux);
    return found.collisions + collisions;
}

}  // namespace searchlight
