#include "transport/slab/slab_mix.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace searchlight {

namespace {

// Where a mix knows less than so many times as well as the analogue estimator, that costs this many times as much as a
// gain elsewhere brings. Pilots are short: hence more than 1.
constexpr double kEnough = 1.1, kPenalty = 5;
// Pilots see less of what levelled series vary by: there they are levelled to what does not vary.
constexpr double kDoubtAngles = 1.4, kDoubtDepths = 3;
// So much better, in the mean of logarithms, have analogue walks to be to stay alone.
constexpr double kAlone = 0.5;
// More is not asked for.
constexpr double kMost = 8;
// Of the time, for analogue walks beside those that foresee.
constexpr double kFewestBeside = 0.2, kMostBeside = 0.9;
constexpr int kShares = 28;

// Neighbouring slots that are judged as one.
struct Group {
    std::size_t first = 0, count = 0;
    double weight = 1;
    double doubt = 1;  // times as much does a walk that foresees vary as it seems to
    // Merit over that of the analogue estimator, if the kind had all of the time.
    double foreseeing = 0, depth = 0, place = 0;
    // Variance of a walk that foresees over that of the others.
    double over_depth = 0, over_place = 0;
};

double median(std::vector<double>& list) {
    const auto middle = list.begin() + static_cast<std::ptrdiff_t>(list.size() / 2);
    std::ranges::nth_element(list, middle);
    return *middle;
}

// False where nothing is known.
bool judge(const SlabKnowledge& knowledge, Group& group) {
    const auto gain = [&](const SlabKnowledge::Kind& kind, std::size_t slot) {
        return knowledge.analogue.variance[slot] * knowledge.analogue.time / (kind.variance[slot] * kind.time);
    };
    std::vector<double> foreseeing, depth, place, over_depth, over_place;
    for (std::size_t slot = group.first; slot < group.first + group.count; ++slot) {
        const double variance = knowledge.foreseeing.variance[slot];
        if (!(variance > 0 && knowledge.analogue.variance[slot] > 0 && knowledge.place.variance[slot] > 0)) continue;
        foreseeing.push_back(gain(knowledge.foreseeing, slot));
        depth.push_back(gain(knowledge.depth, slot));
        place.push_back(gain(knowledge.place, slot));
        over_depth.push_back(variance / knowledge.depth.variance[slot]);
        over_place.push_back(variance / knowledge.place.variance[slot]);
    }
    if (foreseeing.empty()) return false;
    group.foreseeing = median(foreseeing) / group.doubt;
    group.depth = median(depth);
    group.place = median(place);
    group.over_depth = median(over_depth);
    group.over_place = median(over_place);
    return true;
}

std::vector<Group> groupsOf(const SlabLayout& layout, const SlabKnowledge& knowledge) {
    std::vector<Group> groups;
    const auto cut = [&](SlabLayout::Run run, std::size_t parts, double weight, double doubt = 1) {
        const std::size_t size = layout.size(run);
        parts = std::min(parts, size);
        for (std::size_t i = 0; i < parts; ++i) {
            const std::size_t begin = size * i / parts, end = size * (i + 1) / parts;
            Group group{layout.first(run) + begin, end - begin, weight / static_cast<double>(parts), doubt};
            if (judge(knowledge, group)) groups.push_back(group);
        }
    };
    cut(SlabLayout::R_scattered, 1, 0.3);
    cut(SlabLayout::R_single, 1, 0);
    cut(SlabLayout::T_scattered, 1, 0.3);
    cut(SlabLayout::A_total, 1, 0.3);
    cut(SlabLayout::A_layer, layout.size(SlabLayout::A_layer), 0);
    cut(SlabLayout::R_r, 4, 2);
    cut(SlabLayout::T_r, 4, 2);
    cut(SlabLayout::R_a, 3, 1, kDoubtAngles);
    cut(SlabLayout::T_a, 3, 1, kDoubtAngles);
    cut(SlabLayout::A_z, 4, 1, kDoubtDepths);
    return groups;
}

double scoreOf(const std::vector<Group>& groups, double foreseeing, double depth, double place, double penalty) {
    double score = 0;
    for (const Group& group : groups) {
        if (group.weight == 0) continue;
        const double merit = foreseeing * group.foreseeing + depth * group.depth + place * group.place;
        score += group.weight * (std::log(std::min(merit, kMost)) - penalty * std::max(0.0, std::log(kEnough / merit)));
    }
    return score;
}

}  // namespace

SlabMix chooseMix(const SlabLayout& layout, const SlabKnowledge& knowledge) {
    const std::vector<Group> groups = groupsOf(layout, knowledge);
    SlabMix mix;
    if (groups.empty()) return mix;
    // Nothing is uncertain of these alone.
    double best = scoreOf(groups, 0, 0, 1, 0) - kAlone;
    for (int i = 0; i <= kShares; ++i) {
        const double beside = kFewestBeside + (kMostBeside - kFewestBeside) * i / kShares;
        for (const bool places : {false, true}) {
            const double score = scoreOf(groups, 1 - beside, places ? 0 : beside, places ? beside : 0, kPenalty);
            if (!(score > best)) continue;
            best = score;
            mix.foresees = true;
            mix.places = places;
            mix.beside =
                beside / (1 - beside) * knowledge.foreseeing.time / (places ? knowledge.place : knowledge.depth).time;
        }
    }
    if (!mix.foresees) return mix;
    // What a pilot hardly met is left to walks that count: these know how little they know.
    mix.part.assign(layout.slots(), 1.0);
    for (const SlabLayout::Run run :
         {SlabLayout::R_r, SlabLayout::R_r_single, SlabLayout::R_r_multiple, SlabLayout::T_r})
        std::fill_n(mix.part.begin() + static_cast<std::ptrdiff_t>(layout.first(run)), layout.size(run), 0.0);
    for (const Group& group : groups) {
        // The part that makes the variance of the mix least.
        const double variance = (mix.places ? group.over_place : group.over_depth) * mix.beside;
        const double part = std::isinf(variance) ? 1 : variance / (variance + 1);
        std::fill_n(mix.part.begin() + static_cast<std::ptrdiff_t>(group.first), group.count, part);
    }
    return mix;
}

}  // namespace searchlight
