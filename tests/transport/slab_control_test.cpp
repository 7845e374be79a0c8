// Controls of analogue walks, and walks that know depths alone.
#include "transport/slab/slab_control.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "judge.h"
#include "transport/slab/slab_pilot.h"
#include "transport/walk/diffusion.h"

namespace searchlight {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

struct Case {
    const char* name;
    SlabWalk walk;
};

// Isotropic, forward and tabulated scattering, glass, a layer without absorption, oblique light.
std::vector<Case> cases() {
    std::vector<Case> all(6);
    all[0] = {"forward", {}};
    all[0].walk.layers = {
        {.mfp_mm = 0.1, .absorbed = 0.02, .g = 0.8, .thickness_mm = 1, .eta_up = 1.4, .eta_down = 1.4}};
    all[1] = {"half-space", {}};
    all[1].walk.layers = {{.mfp_mm = 1, .absorbed = 0.1, .thickness_mm = infinity, .eta_up = 1.5}};
    all[2] = {"without absorption", {}};
    all[2].walk.layers = {{.mfp_mm = 1, .thickness_mm = 4, .eta_up = 1.3, .eta_down = 1.3}};
    all[3] = {"glass, two layers", {}};
    all[3].walk.layers = {
        {.mfp_mm = 1e30, .thickness_mm = 1, .eta_up = 1.5, .eta_down = 1.5 / 1.3},
        {.mfp_mm = 0.5, .absorbed = 0.05, .g = -0.4, .thickness_mm = 1, .eta_up = 1.3 / 1.5, .eta_down = 1.3 / 1.4},
        {.mfp_mm = 0.7, .absorbed = 0.01, .g = 0.5, .thickness_mm = 2, .eta_up = 1.4 / 1.3, .eta_down = 1.4}};
    all[3].walk.first = 1;
    all[3].walk.sin_beam = 0.6;
    all[3].walk.cos_beam = 0.8;
    all[4] = {"Rayleigh", {}};
    all[4].walk.layers = {{.mfp_mm = 1, .absorbed = 0.1, .thickness_mm = 2, .eta_up = 1.4, .eta_down = 1.4}};
    all[4].walk.layers[0].phase = all[4].walk.tables.add(rayleighPhase());
    all[5] = {"matched", {}};
    all[5].walk.layers = {{.mfp_mm = 1, .thickness_mm = 1}};
    return all;
}

SlabLayout layoutOf(const SlabWalk& walk) {
    std::vector<SlabLayout::Layer> layers;
    double top = 0;
    for (const SlabWalk::Layer& layer : walk.layers) {
        layers.push_back({top, layer.absorbed, layer.mfp_mm});
        top += layer.thickness_mm;
    }
    const double edges[] = {0, 1};
    return {edges, 4, 5, 3, {}, layers};
}

TEST(SlabControl, DecayIsThatOfTheDispersionRelation) {
    for (const double absorbed : {1e-4, 0.01, 0.3}) {
        SlabWalk walk;
        walk.layers = {{.absorbed = absorbed}};
        const SlabControl control(walk);
        ASSERT_EQ(control.layers.size(), 1u);
        EXPECT_NEAR(control.layers[0].kappa, asymptoticDecay(absorbed), 1e-9);
    }
}

// A peak would leave all to a few walks.
TEST(SlabControl, StrongAbsorptionHasNone) {
    SlabWalk walk;
    walk.layers = {{.absorbed = 0.9}};
    EXPECT_TRUE(SlabControl(walk).layers.empty());
}

// Relative errors are some 0.3 %: of what walks gain at one surface.
TEST(SlabControl, ControlsAreZeroOnAverage) {
    Judge judge;
    for (const Case& one : cases())
        for (const bool depths_alone : {false, true}) {
            SlabWalk walk = one.walk;
            for (SlabWalk::Layer& layer : walk.layers) layer.counted = layer.mfp_mm > 1e20 ? 0 : 1;
            const SlabLayout layout = layoutOf(walk);
            const SlabControl control(walk);
            const SlabDepths depths(walk, layout);
            EXPECT_FALSE(control.layers.empty()) << one.name;
            BatchRatios found(control.size());
            constexpr std::uint64_t chunks = 100, walks = 1000;
            for (std::uint64_t chunk = 0; chunk < chunks; ++chunk) {
                SlabTally tally(layout);
                std::vector<double> sums(SlabControl::kSums * control.layers.size());
                if (depths_alone)
                    walkSlabDepthsChunk(walk, 8, chunk, walks, tally, control, sums, depths);
                else
                    walkSlabChunk(walk, 9, chunk, walks, tally, control, sums);
                const double n = walks;
                found.add(control.controls(sums, tally.flux()[layout.first(SlabLayout::R_unscattered)],
                                           tally.flux()[layout.first(SlabLayout::T_unscattered)], n),
                          n);
            }
            for (std::size_t i = 0; i < control.size(); ++i)
                if (const Estimate e = found.estimate(i, chunks * walks); e.standard_error > 1e-7)
                    judge.compare(std::string(one.name) + (depths_alone ? ", depths alone" : "") + ", control " +
                                      std::to_string(i),
                                  e, 0);
        }
    judge.expectAgreement();
}

// They share their physics, not their random numbers.
TEST(SlabControl, WalksThatKnowDepthsAloneFindTheSame) {
    Judge judge;
    for (const Case& one : cases()) {
        SlabWalk walk = one.walk;
        for (SlabWalk::Layer& layer : walk.layers) layer.counted = layer.mfp_mm > 1e20 ? 0 : 1;
        const SlabLayout layout = layoutOf(walk);
        const SlabControl control(walk);
        const SlabDepths depths(walk, layout);
        BatchRatios whole(layout.slots()), depth(layout.slots());
        constexpr std::uint64_t chunks = 64, walks = 1000;
        for (std::uint64_t chunk = 0; chunk < chunks; ++chunk) {
            std::vector<double> sums(SlabControl::kSums * control.layers.size());
            SlabTally a(layout), b(layout);
            walkSlabChunk(walk, 10, chunk, walks, a);
            walkSlabDepthsChunk(walk, 11, chunk, walks, b, control, sums, depths);
            whole.add(a.flux(), walks);
            depth.add(b.flux(), walks);
        }
        for (const SlabLayout::Run run :
             {SlabLayout::R_scattered, SlabLayout::R_single, SlabLayout::T_scattered, SlabLayout::A_total,
              SlabLayout::A_layer, SlabLayout::R_a, SlabLayout::T_a, SlabLayout::A_z, SlabLayout::F_z})
            for (std::size_t slot = layout.first(run); slot < layout.first(run) + layout.size(run); ++slot) {
                const Estimate a = whole.estimate(slot, chunks * walks), b = depth.estimate(slot, chunks * walks);
                if (a.mean > 0 || b.mean > 0)
                    judge.compare(std::string(one.name) + ", slot " + std::to_string(slot),
                                  {b.mean, std::hypot(a.standard_error, b.standard_error), 0}, a.mean,
                                  std::pow(a.mean / a.standard_error, 2));
            }
    }
    judge.expectAgreement();
}

// What the regression is for: per walk, R, T and A of a slab that walks cross often.
TEST(SlabControl, TotalsFollowTheirControls) {
    SlabWalk walk;
    walk.layers = {{.mfp_mm = 1, .absorbed = 0.01, .counted = 1, .thickness_mm = 5, .eta_up = 1.4, .eta_down = 1.4}};
    const SlabLayout layout = layoutOf(walk);
    const SlabControl control(walk);
    const SlabPilot pilot(walk, control, SlabDepths(walk, layout), layout);
    for (const SlabLayout::Run run : {SlabLayout::R_scattered, SlabLayout::T_scattered, SlabLayout::A_total}) {
        const std::size_t slot = pilot.layout.first(run);
        EXPECT_LT(pilot.variance[slot], 0.3 * pilot.analogue_variance[slot]) << run;
    }
}

}  // namespace
}  // namespace searchlight
