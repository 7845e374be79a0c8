// What the best estimator of slabs decides before it walks: how its time is divided between the walks that foresee
// where light leaves and analogue walks beside them.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "transport/slab/slab_best.h"
#include "transport/slab/slab_best_flux.h"

namespace searchlight {

namespace {

// As in half_space_plan.cpp.
constexpr double kMostForesight = 0.7;

// The pilot has numbers of its own, the same for every seed.
constexpr std::uint64_t kPilotSeed = 0x736C6162, kBesideStream = 0x626573696465;
constexpr std::uint64_t kPilotChunks = 16, kPilotWalks = 128;
constexpr double kStepTime = 7.5, kStart = 10, kAnalogueStepTime = 3.1, kDepthStepTime = 2.8,
                 kAnalogueStart = 10;  // ns

// Few walks are heavy, so that a pilot sees too little of a variance.
constexpr double kUnseen = 1.5;

// Where walks that foresee know R(r) less than so many times better than analogue walks, they stay at home; where R(r)
// or T(r) less than the other, the analogue walks have a part in these, too.
constexpr double kWorthwhile = 1.7, kAlone = 1.6;
// The part of the time for analogue walks, which know totals and depths better, and most of it for those with a part in
// R(r); and how well A(z) has to be known against the analogue estimator: pilots are short.
constexpr double kLeastBeside = 0.4, kMostBeside = 0.55, kPlacesBeside = 0.65, kEnough = 1.25;

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
    const double part = up + down > 0 ? up / (up + down) : 0.5;
    return {part, 1 - part, 0};
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
    missing = partsOfMissing(pilot, pilot.covariance, {pilot.often[0], pilot.often[1], absorbs && pilot.often[2]});
    if (!canForesee(slab, tallied)) return;
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
    shape = shapeOf(*this, chunks);
    std::vector<double> better = pilot.spread(pilot.mean, layout);
    for (double& mean : better) mean *= static_cast<double>(kPilotWalks);
    constexpr std::uint64_t walks = kPilotChunks * kPilotWalks;
    const double time = kStart + kStepTime * static_cast<double>(steps) / walks;
    const double place_time = kAnalogueStart + kAnalogueStepTime * pilot.steps;
    const double depth_time = kAnalogueStart + kDepthStepTime * pilot.steps;
    const auto batches = [&] {
        BatchRatios sums(layout.slots());
        for (const SlabBestSums& found : chunks) sums.add(fluxOf(*this, found, kPilotWalks, better), kPilotWalks);
        return sums;
    };
    {
        // The totals are not levelled, so that they tell how far the series should be.
        const BatchRatios totals = batches();
        const double least_beside = kLeastBeside / (1 - kLeastBeside) * time / depth_time;
        const auto partOf = [&](SlabLayout::Run run, std::size_t i) {
            const std::size_t slot = pilot.layout.first(run) + i;
            if (!(pilot.mean[slot] > 0)) return 0.0;
            const double error = totals.estimate(layout.first(run) + i, walks).standard_error;
            const double foreseeing = kUnseen * error * error * walks;
            const double other = pilot.variance[slot] / least_beside;
            return foreseeing > 0 ? foreseeing / (foreseeing + other) : 0;
        };
        for (double& value : shape.reflected_a) value *= partOf(SlabLayout::R_scattered, 0);
        for (double& value : shape.transmitted_a) value *= partOf(SlabLayout::T_scattered, 0);
        std::vector<double> layer_parts;
        for (std::size_t i = 0; i < slab.layers.size(); ++i) layer_parts.push_back(partOf(SlabLayout::A_layer, i));
        for (std::size_t i = 0; i < depths.slots.size(); ++i) shape.collided[i] *= layer_parts[depths.slots[i].layer];
    }
    const BatchRatios best = batches();
    std::vector<std::size_t> layer_at(layout.depths());
    for (auto slot = depths.slots.rbegin(); slot != depths.slots.rend(); ++slot) layer_at[slot->depth] = slot->layer;
    // Variances of single walks, relative to the square of what they find; slots that nothing reached have none.
    struct Relative {
        double foreseeing = 0, depth = 0, place = 0;
    };
    const auto relative = [&](SlabLayout::Run run, std::size_t i) {
        const Estimate flux = best.estimate(layout.first(run) + i, walks);
        if (!(flux.mean > 0)) return Relative{};
        const double foreseeing = kUnseen * std::pow(flux.standard_error / flux.mean, 2) * walks;
        // What the analogue walk counts has the variance of counts.
        if (run == SlabLayout::R_r || run == SlabLayout::T_r)
            return Relative{foreseeing, 0, (1 - std::min(flux.mean, 0.99)) / flux.mean};
        const std::size_t slot = pilot.layout.first(run) + i;
        const double mean = pilot.mean[slot], square = mean * mean;
        if (!(mean > 0)) return Relative{};
        double place = pilot.analogue_variance[slot] / square;
        if (run == SlabLayout::A_z) {
            // The analogue estimator counts a part of the collisions alone.
            const std::size_t index = layer_at[i];
            place += std::max(0.0, layout.layers()[index].absorbed - slab.layers[index].absorbed) / mean;
        }
        return Relative{foreseeing, pilot.variance[slot] / square, place};
    };
    // How much better than by the analogue estimator in the same time by walks that foresee, and by the analogue walks
    // beside them, and the variance of the first over that of the last: of half of the slots more, of half less.
    struct Gain {
        double foreseeing = std::numeric_limits<double>::infinity(), beside = 1, quotient = 0;
    };
    const auto gain = [&](SlabLayout::Run run, std::size_t skip, double beside_time) {
        std::vector<double> foreseeing, besides, quotients;
        for (std::size_t i = skip; i + skip < layout.size(run); ++i) {
            const Relative r = relative(run, i);
            if (!(r.foreseeing > 0 && r.place > 0)) continue;
            const double other = r.depth > 0 ? r.depth : r.place;
            foreseeing.push_back(r.place * place_time / (r.foreseeing * time));
            besides.push_back(r.place * place_time / (other * beside_time));
            quotients.push_back(r.foreseeing / other);
        }
        if (foreseeing.empty()) return Gain{};
        const auto median = [](std::vector<double>& list) {
            const auto middle = list.begin() + static_cast<std::ptrdiff_t>(list.size() / 2);
            std::ranges::nth_element(list, middle);
            return *middle;
        };
        return Gain{median(foreseeing), median(besides), median(quotients)};
    };
    const double R_gain = gain(SlabLayout::R_r, 1, place_time).foreseeing;
    if (R_gain < kWorthwhile) return;
    worthwhile = true;
    places = std::min(R_gain, gain(SlabLayout::T_r, 1, place_time).foreseeing) < kAlone;
    const double beside_time = places ? place_time : depth_time;
    const Gain depth = gain(SlabLayout::A_z, 0, beside_time);
    double share = kLeastBeside;
    if (depth.foreseeing < kEnough && depth.beside > depth.foreseeing)
        share = std::max(share, (kEnough - depth.foreseeing) / (depth.beside - depth.foreseeing));
    share = places ? kPlacesBeside : std::min(share, kMostBeside);
    beside = share / (1 - share) * time / beside_time;
    // The part that makes the relative variance of the mix least.
    const auto choose = [&](SlabLayout::Run run, std::size_t skip) {
        const double variance = gain(run, skip, beside_time).quotient * beside;
        part[run] = variance / (variance + 1);
    };
    for (const SlabLayout::Run run :
         {SlabLayout::R_scattered, SlabLayout::R_single, SlabLayout::T_scattered, SlabLayout::A_total,
          SlabLayout::A_layer, SlabLayout::R_a, SlabLayout::T_a, SlabLayout::A_z})
        choose(run, 0);
    if (places) {
        choose(SlabLayout::R_r, 1);
        choose(SlabLayout::T_r, 1);
    }
    part[SlabLayout::F_z] = part[SlabLayout::A_z];
    // What analogue walks say of order 1 is of no use where nearly all of it is known, and of nothing where all is.
    const bool mixes_single = !single || std::ranges::count(foresees, 0) > 0;
    if (!mixes_single) part[SlabLayout::R_single] = 0;
    part[SlabLayout::R_r_single] = mixes_single ? part[SlabLayout::R_r] : 0;
    part[SlabLayout::R_r_multiple] = part[SlabLayout::R_r];

    std::vector<std::array<double, 3>> ends;
    for (const SlabBestSums& found : chunks) {
        const std::vector<double> flux = fluxOf(*this, found, kPilotWalks, better);
        std::array<double, 3>& end = ends.emplace_back();
        for (std::size_t i = 0; i < 3; ++i) end[i] = flux[layout.first(kEnds[i])];
    }
    Covariance mixed = covarianceOf(ends);
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) {
            const double a = part[kEnds[i]], b = part[kEnds[j]];
            mixed[i][j] = a * b * pilot.covariance[i][j] / beside + (1 - a) * (1 - b) * mixed[i][j];
        }
    missing = partsOfMissing(pilot, mixed, {true, true, absorbs});
}

std::uint64_t walkSlabBestChunk(const SlabBestPlan& plan, std::uint64_t seed, std::uint64_t chunk, std::uint64_t walks,
                                SlabTally& tally) {
    const SlabLayout& layout = plan.layout;
    const double n = static_cast<double>(walks);
    const auto count = plan.worthwhile ? static_cast<std::uint64_t>(std::ceil(n * plan.beside)) : walks;
    std::vector<double> sums(SlabControl::kSums * plan.control.layers.size()), flux;
    std::uint64_t collisions = 0;
    if (plan.worthwhile && !plan.places) {
        SlabTally beside(plan.pilot.layout);
        collisions =
            walkSlabDepthsChunk(plan.walk, seed ^ kBesideStream, chunk, count, beside, plan.control, sums, plan.depths);
        flux = plan.pilot.spread(beside.flux(), layout);
    } else {
        SlabTally beside(layout);
        collisions = walkSlabChunk(plan.walk, plan.worthwhile ? seed ^ kBesideStream : seed, chunk, count, beside,
                                   plan.control, sums);
        flux = beside.pack();
    }
    plan.pilot.correct(plan.control, sums, static_cast<double>(count), layout, flux);
    if (!plan.worthwhile) {
        completeTotals(plan, n, flux);
        tally.unpack(flux);
        return collisions;
    }
    SlabBestSums found = walkForeseeingSlabChunk(plan, streamOf(seed, chunk), walks);
    addKnown(plan, n, found);
    for (double& value : flux) value *= n / static_cast<double>(count);
    const std::vector<double> mine = fluxOf(plan, found, n, flux);
    for (std::size_t run = 0; run < SlabLayout::runs; ++run) {
        const auto which = static_cast<SlabLayout::Run>(run);
        const double part = plan.part[run];
        for (std::size_t slot = layout.first(which); slot < layout.first(which) + layout.size(which); ++slot)
            flux[slot] = part * flux[slot] + (1 - part) * mine[slot];
    }
    completeTotals(plan, n, flux);
    tally.unpack(flux);
    return found.collisions + collisions;
}

}  // namespace searchlight
