// What the best estimator of slabs decides before it walks: how its time is divided between the walks that foresee
// where light leaves and analogue walks beside them.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "transport/slab/slab_best.h"
#include "transport/slab/slab_best_flux.h"

namespace searchlight {

namespace {

// As in half_space_plan.cpp.
constexpr double kMostForesight = 0.7;

// The pilots have numbers of their own, the same for every seed.
constexpr std::uint64_t kPilotSeed = 0x736C6162, kLedPilotSeed = 0x6C656470;
constexpr std::uint64_t kPilotChunks = 32, kPilotWalks = 128, kAllPilotWalks = kPilotChunks * kPilotWalks;

// ns, on one core of an AVX-512 Xeon: what counts are their quotients. A step is dearer where one of 16 lanes meets an
// interface.
constexpr double kStart = 10, kIsotropicStep = 1.7, kStep = 2.7, kMeeting = 3.5;
constexpr double kControl = 0.4, kLayeredControl = 1.5;  // for each control and crossing; in one layer, in several
// Of walks that know their depth alone, with controls, over others; looking up layers costs them more.
constexpr double kDepthTime = 0.9, kIsotropicDepthTime = 0.97, kLayeredDepthTime = 1.1;
constexpr double kIsotropicForeseeing = 7.3, kForeseeing = 9.2, kLayeredForeseeing = 14.5;
// Of the time of analogue walks that are alone, for controls: what these add to totals they take from R(r).
constexpr double kControlPart = 0.02;

// Few walks are heavy, so that a pilot sees too little of a variance.
constexpr double kUnseen = 1.5;
// What series are levelled to is known by analogue walks with this part of the time, at least.
constexpr double kLeastBeside = 0.4;
// What absorbs less is known better by walks that are led.
constexpr double kRare = 0.01;
// Part of the time for walks that are led: what they know, others hardly know at all.
constexpr double kLedPart = 0.1;

// Whether walks that foresee can serve the slab. A phase function that is a table is not known point by point; clear
// layers carry light far away, where an importance from diffusion does harm. Maps are tallied by analogue walks alone.
bool canForesee(const SlabWalk& walk, const SlabLayout& layout) {
    // What is clear has a free path longer than anything.
    const bool clear = std::ranges::any_of(walk.layers, [](const SlabWalk::Layer& l) { return l.mfp_mm > 1e20; });
    return walk.tables.stay.empty() && !clear && !layout.maps() && layout.grid() == 0;
}

using Covariance = std::array<std::array<double, 3>, 3>;  // of R, T and A, per walk

constexpr SlabLayout::Run kEnds[] = {SlabLayout::R_scattered, SlabLayout::T_scattered, SlabLayout::A_total};

// Per walk, of what chunks of kPilotWalks found.
Covariance covarianceOf(const std::vector<std::array<double, 3>>& ends) {
    const double chunks = static_cast<double>(ends.size());
    Covariance result{};
    std::array<double, 3> mean{};
    for (const std::array<double, 3>& end : ends)
        for (std::size_t i = 0; i < 3; ++i) mean[i] += end[i] / chunks;
    for (const std::array<double, 3>& end : ends)
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t j = 0; j < 3; ++j)
                result[i][j] += (end[i] - mean[i]) * (end[j] - mean[j]) / ((chunks - 1) * kPilotWalks);
    return result;
}

// Numbers whose sum is known have the least variance when each gets of what is missing in proportion to its covariance
// with the sum.
std::array<double, 3> partsOfMissing(const SlabPilot& pilot, const Covariance& covariance,
                                     const std::array<bool, 3>& known) {
    std::array<double, 3> parts{};
    double sum = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        if (known[i]) parts[i] = std::max(0.0, covariance[i][0] + covariance[i][1] + covariance[i][2]);
        sum += parts[i];
    }
    // Less is rounding: the sum of R, T and A follows the controls.
    if (sum > 1e-12) {
        for (double& part : parts) part /= sum;
        return parts;
    }
    const double up = pilot.mean[pilot.layout.first(SlabLayout::R_scattered)];
    const double down = pilot.mean[pilot.layout.first(SlabLayout::T_scattered)];
    if (!(up + down > 0)) return {0, 0, 1};
    return {up / (up + down), down / (up + down), 0};
}

}  // namespace

SlabBestPlan::SlabBestPlan(const SlabWalk& slab, std::span<const double> edges, const SlabLayout& tallied)
    : walk(slab),
      layout(tallied),
      control(slab),
      depths(slab, tallied),
      pilot(slab, control, depths, tallied),
      bins(laneBins(edges)) {
    for (const SlabWalk::Layer& layer : slab.layers) {
        foresees.push_back(layer.g <= kMostForesight);
        absorbs |= layer.absorbed > 0;
    }
    const bool has_below = !std::isinf(slab.layers.back().thickness_mm);
    missing = partsOfMissing(pilot, pilot.covariance,
                             {pilot.often[0], has_below && pilot.often[1], absorbs && pilot.often[2]});
    if (const double part = controlTime() / analogueTime(); part > kControlPart) controlled = kControlPart / part;
    if (!canForesee(slab, tallied)) return;
    const bool opaque = isOpaque(slab) && has_below;
    if (std::ranges::count(foresees, 1) == 0) {
        if (opaque) planLead(0);
        return;
    }
    importance = makeSlabImportance(slab, edges);
    if (slab.sin_beam == 0 && slab.shape.kind == BeamShape::pencil)
        single = slabSingle(slab, edges, foresees, tallied.angles());

    std::vector<SlabBestSums> chunks;
    std::uint64_t steps = 0;
    for (std::uint64_t chunk = 0; chunk < kPilotChunks; ++chunk) {
        chunks.push_back(walkForeseeingSlabChunk(*this, streamOf(kPilotSeed, chunk), kPilotWalks));
        steps += chunks.back().steps;
        addKnown(*this, kPilotWalks, chunks.back());
    }
    const double time = foreseeingTime(steps);
    planShape(chunks, time);
    std::vector<double> better = pilot.spread(pilot.mean, layout);
    for (double& mean : better) mean *= static_cast<double>(kPilotWalks);
    BatchRatios sums(layout.slots());
    std::vector<std::array<double, 3>> ends;
    for (const SlabBestSums& found : chunks) {
        const std::vector<double> flux = fluxOf(*this, found, kPilotWalks, better);
        sums.add(flux, kPilotWalks);
        std::array<double, 3>& end = ends.emplace_back();
        for (std::size_t i = 0; i < 3; ++i) end[i] = flux[layout.first(kEnds[i])];
    }
    mix = chooseMix(layout, knowledgeOf(sums, time));
    if (mix.foresees) {
        copyParts();
        Covariance mixed = covarianceOf(ends);
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t j = 0; j < 3; ++j) {
                const double a = mix.part[layout.first(kEnds[i])], b = mix.part[layout.first(kEnds[j])];
                mixed[i][j] = a * b * pilot.covariance[i][j] / mix.beside + (1 - a) * (1 - b) * mixed[i][j];
            }
        missing = partsOfMissing(pilot, mixed, {true, has_below, absorbs});
    }
    if (opaque) planLead(time);
}

bool SlabBestPlan::isotropic() const {
    return std::ranges::all_of(walk.layers, [](const SlabWalk::Layer& layer) { return layer.g == 0; });
}

// Of one walk, ns.
double SlabBestPlan::controlTime() const {
    const double controls = static_cast<double>(control.layers.size());
    return (walk.layers.size() > 1 ? kLayeredControl : kControl) * controls * pilot.crossings;
}

double SlabBestPlan::analogueTime() const {
    const double steps = pilot.steps + pilot.crossings;
    const double meets = 1 - std::pow(1 - pilot.crossings / steps, 16);
    return kStart + ((isotropic() ? kIsotropicStep : kStep) + kMeeting * meets) * steps;
}

double SlabBestPlan::besideTime(bool places) const {
    if (places) return analogueTime() + controlTime();
    return analogueTime() * (walk.layers.size() > 1 ? kLayeredDepthTime
                             : isotropic()          ? kIsotropicDepthTime
                                                    : kDepthTime);
}

double SlabBestPlan::foreseeingTime(std::uint64_t steps) const {
    const double step = walk.layers.size() > 1 ? kLayeredForeseeing : isotropic() ? kIsotropicForeseeing : kForeseeing;
    return kStart + step * static_cast<double>(steps) / kAllPilotWalks;
}

// Where series of walks that foresee are levelled to the totals of others, and how far.
void SlabBestPlan::planShape(const std::vector<SlabBestSums>& chunks, double time) {
    shape = shapeOf(*this, chunks);
    // These are not levelled, so that they tell how far the series should be.
    BatchRatios totals(layout.slots());
    for (const SlabBestSums& found : chunks) totals.add(fluxOf(*this, found, kPilotWalks, {}), kPilotWalks);
    const double least_beside = kLeastBeside / (1 - kLeastBeside) * time / besideTime(false);
    const auto partOf = [&](SlabLayout::Run run, std::size_t i) {
        const std::size_t slot = pilot.layout.first(run) + i;
        if (!(pilot.mean[slot] > 0)) return 0.0;
        const double error = totals.estimate(layout.first(run) + i, kAllPilotWalks).standard_error;
        const double foreseeing = kUnseen * error * error * kAllPilotWalks;
        const double other = pilot.variance[slot] / least_beside;
        return foreseeing > 0 ? foreseeing / (foreseeing + other) : 0;
    };
    for (double& value : shape.reflected_a) value *= partOf(SlabLayout::R_scattered, 0);
    for (double& value : shape.transmitted_a) value *= partOf(SlabLayout::T_scattered, 0);
    std::vector<double> layer_parts;
    for (std::size_t i = 0; i < walk.layers.size(); ++i) layer_parts.push_back(partOf(SlabLayout::A_layer, i));
    for (std::size_t i = 0; i < depths.slots.size(); ++i) shape.collided[i] *= layer_parts[depths.slots[i].layer];
}

// best: of the pilot's walks that foresee.
SlabKnowledge SlabBestPlan::knowledgeOf(const BatchRatios& best, double time) const {
    constexpr double nothing = std::numeric_limits<double>::infinity();
    const auto unknown = [&](double time_ns) {
        return SlabKnowledge::Kind{time_ns, std::vector<double>(layout.slots())};
    };
    SlabKnowledge knowledge{unknown(time), unknown(besideTime(false)), unknown(besideTime(true)),
                            unknown(analogueTime())};
    std::vector<std::size_t> layer_at(layout.depths());
    for (auto slot = depths.slots.rbegin(); slot != depths.slots.rend(); ++slot) layer_at[slot->depth] = slot->layer;
    // Not of A per layer: how heavy few walks deep down are no pilot knows, and controls know it well.
    for (const SlabLayout::Run run :
         {SlabLayout::R_scattered, SlabLayout::R_single, SlabLayout::T_scattered, SlabLayout::A_total, SlabLayout::R_r,
          SlabLayout::T_r, SlabLayout::R_a, SlabLayout::T_a, SlabLayout::A_z})
        for (std::size_t i = 0; i < layout.size(run); ++i) {
            const std::size_t slot = layout.first(run) + i;
            const Estimate flux = best.estimate(slot, kAllPilotWalks);
            if (!(flux.mean > 0)) continue;
            const double foreseeing = kUnseen * std::pow(flux.standard_error / flux.mean, 2) * kAllPilotWalks;
            double depth = nothing, place = 0, analogue = 0;
            if (run == SlabLayout::R_r || run == SlabLayout::T_r) {
                // What analogue walks count has the variance of counts.
                place = analogue = (1 - std::min(flux.mean, 0.99)) / flux.mean;
            } else {
                const std::size_t known = pilot.layout.first(run) + i;
                const double mean = pilot.mean[known], square = mean * mean;
                if (!(mean > 0)) continue;
                depth = place = pilot.variance[known] / square;
                analogue = pilot.analogue_variance[known] / square;
                if (run == SlabLayout::A_z) {
                    // Those that know their place count a part of the collisions alone.
                    const std::size_t index = layer_at[i];
                    const double more =
                        std::max(0.0, layout.layers()[index].absorbed - walk.layers[index].absorbed) / mean;
                    place += more;
                    analogue += more;
                }
            }
            knowledge.foreseeing.variance[slot] = foreseeing;
            knowledge.depth.variance[slot] = depth;
            knowledge.place.variance[slot] = place;
            knowledge.analogue.variance[slot] = analogue;
        }
    return knowledge;
}

// Of series that have no knowledge of their own.
void SlabBestPlan::copyParts() {
    const auto part = [&](SlabLayout::Run run) {
        return mix.part.begin() + static_cast<std::ptrdiff_t>(layout.first(run));
    };
    const auto copy = [&](SlabLayout::Run from, SlabLayout::Run to) {
        std::copy_n(part(from), layout.size(from), part(to));
    };
    copy(SlabLayout::A_z, SlabLayout::F_z);
    // In one layer what little is absorbed is known where it is not deep.
    if (walk.layers.size() == 1 && !pilot.often[2]) *part(SlabLayout::A_total) = 0;
    copy(SlabLayout::R_r, SlabLayout::R_r_multiple);
    // What analogue walks say of order 1 is of no use where nearly all of it is known, and of nothing where all is.
    if (!single || std::ranges::count(foresees, 0) > 0)
        copy(SlabLayout::R_r, SlabLayout::R_r_single);
    else
        *part(SlabLayout::R_single) = 0;
}

void SlabBestPlan::planLead(double time) {
    lead = leadThrough(walk);
    BatchRatios sums(layout.slots());
    std::uint64_t steps = 0;
    for (std::uint64_t chunk = 0; chunk < kPilotChunks; ++chunk) {
        SlabBestSums found = walkForeseeingSlabChunk(*this, streamOf(kLedPilotSeed, chunk), kPilotWalks, &*lead);
        steps += found.steps;
        addKnown(*this, kPilotWalks, found);
        sums.add(fluxOf(*this, found, kPilotWalks, {}), kPilotWalks);
    }
    const double others = mix.foresees ? time + mix.beside * besideTime(mix.places) : besideTime(true);
    lead->share = kLedPart / (1 - kLedPart) * others / foreseeingTime(steps);
    lead->part.assign(layout.slots(), 0.0);
    lead->event.assign(layout.slots(), 0.0);
    const double T = sums.estimate(layout.first(SlabLayout::T_scattered), kAllPilotWalks).mean;
    for (const SlabLayout::Run run : {SlabLayout::T_scattered, SlabLayout::T_r, SlabLayout::T_a})
        for (std::size_t slot = layout.first(run); slot < layout.first(run) + layout.size(run); ++slot) {
            lead->part[slot] = 1;
            lead->event[slot] = T / lead->share;
        }
    missing[1] = 0;
    const double rest = missing[0] + missing[2];
    for (double& part : missing) part = rest > 0 ? part / rest : 0;
    if (!(rest > 0)) missing[absorbs ? 2 : 0] = 1;
    for (std::size_t i = 0; i < layout.size(SlabLayout::A_layer); ++i) {
        const std::size_t slot = layout.first(SlabLayout::A_layer) + i;
        const Estimate flux = sums.estimate(slot, kAllPilotWalks);
        if (!(flux.mean > 0 && flux.mean < kRare)) continue;
        const double led = kUnseen * flux.standard_error * flux.standard_error * kAllPilotWalks / lead->share;
        const double other = flux.mean / (mix.foresees ? mix.beside : 1);
        lead->part[slot] = other / (other + led);
        lead->event[slot] = flux.mean / lead->share;
    }
    // What others know of a depth has at least the variance of counts.
    const double counts = mix.foresees ? mix.beside : 1;
    for (const SlabDepths::Slot& place : depths.slots) {
        const SlabLayout::Layer& counted = layout.layers()[place.layer];
        const bool all = mix.foresees && !mix.places;
        for (const auto& [run, each] :
             {std::pair(SlabLayout::A_z, all ? walk.layers[place.layer].absorbed : counted.absorbed),
              std::pair(SlabLayout::F_z, all ? walk.layers[place.layer].mfp_mm : counted.fluence_mm)}) {
            const std::size_t slot = layout.first(run) + place.depth;
            const Estimate flux = sums.estimate(slot, kAllPilotWalks);
            const double led = kUnseen * flux.standard_error * flux.standard_error * kAllPilotWalks / lead->share;
            const double other = flux.mean * each / counts;
            if (!(other > 0)) continue;
            lead->part[slot] = other / (other + led);
            lead->event[slot] = flux.mean / lead->share;
        }
    }
}

}  // namespace searchlight
