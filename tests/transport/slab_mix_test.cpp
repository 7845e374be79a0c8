// How the best estimator of slabs divides its time.
#include "transport/slab/slab_mix.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace searchlight {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

SlabLayout layout() {
    const std::vector<double> edges{0, 0.5, 1, 2};
    return {edges, 4, 6, 1.0, {}, {{0, 0.1, 1}}};
}

// Every kind takes as long and knows all equally well, but walks that know depths alone no annuli.
SlabKnowledge equal(const SlabLayout& slab) {
    const SlabKnowledge::Kind one{1, std::vector<double>(slab.slots(), 1.0)};
    SlabKnowledge knowledge{one, one, one, one};
    for (const SlabLayout::Run run : {SlabLayout::R_r, SlabLayout::T_r})
        for (std::size_t i = 0; i < slab.size(run); ++i) knowledge.depth.variance[slab.first(run) + i] = infinity;
    return knowledge;
}

TEST(SlabMix, AnalogueWalksStayAloneWhereNothingIsGained) {
    const SlabLayout slab = layout();
    EXPECT_FALSE(chooseMix(slab, equal(slab)).foresees);
    SlabKnowledge slow = equal(slab);
    slow.foreseeing.time = 5;
    EXPECT_FALSE(chooseMix(slab, slow).foresees);
}

TEST(SlabMix, EachSeriesComesFromThoseWhoKnowIt) {
    const SlabLayout slab = layout();
    SlabKnowledge knowledge = equal(slab);
    for (const SlabLayout::Run run : {SlabLayout::R_r, SlabLayout::T_r, SlabLayout::R_a, SlabLayout::T_a})
        for (std::size_t i = 0; i < slab.size(run); ++i) knowledge.foreseeing.variance[slab.first(run) + i] = 0.05;
    for (std::size_t i = 0; i < slab.size(SlabLayout::A_z); ++i) {
        knowledge.foreseeing.variance[slab.first(SlabLayout::A_z) + i] = 9;
        knowledge.depth.variance[slab.first(SlabLayout::A_z) + i] = 0.4;
    }
    const SlabMix mix = chooseMix(slab, knowledge);
    ASSERT_TRUE(mix.foresees);
    EXPECT_FALSE(mix.places);
    const double share = mix.beside / (1 + mix.beside);
    // A(z) is known no worse than by the analogue estimator, from either kind.
    EXPECT_GT(share / 0.4 + (1 - share) / 9, 1);
    EXPECT_EQ(mix.part[slab.first(SlabLayout::R_r)], 0);
    // Of two independent numbers each counts for what it knows.
    EXPECT_NEAR(mix.part[slab.first(SlabLayout::A_z)], 9 / (9 + 0.4 / mix.beside), 1e-12);
    EXPECT_NEAR(mix.part[slab.first(SlabLayout::R_a)], 0.05 / (0.05 + 1 / mix.beside), 1e-12);
}

TEST(SlabMix, WhatNobodyKnowsIsLeftAlone) {
    const SlabLayout slab = layout();
    SlabKnowledge knowledge = equal(slab);
    for (SlabKnowledge::Kind* kind : {&knowledge.foreseeing, &knowledge.depth, &knowledge.place, &knowledge.analogue})
        kind->variance.assign(slab.slots(), 0.0);
    EXPECT_FALSE(chooseMix(slab, knowledge).foresees);
}

}  // namespace
}  // namespace searchlight
