// The low-variance walk of the half-space: at every collision it tallies the light that is expected to leave from
// there, and it is followed only where that still matters.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "base/random.h"
#include "transport/half_space/guided_walk.h"
#include "transport/half_space/half_space_walk.h"
#include "transport/half_space/importance.h"
#include "transport/half_space/single_scattering.h"
#include "transport/walk/lane_bins.h"
#include "transport/walk/tally.h"

namespace searchlight {

/// What all chunks of a job share. Lengths are in mean free paths.
struct BestPlan {
    BestPlan(const HalfSpaceWalk& walk, std::span<const double> edges, const BestTuning& tuning);

    /// The radius that 100 of so many walks would reach without being led. Farther out few flights carry most of the
    /// light, and the scatter of the chunks may have seen none of them.
    double reach(std::uint64_t walks) const;

    HalfSpaceWalk walk;
    BestTuning tuning;
    bool foresees = true;  ///< tallies expected escapes; otherwise what crosses the surface
    ImportanceTable importance;
    LaneBins bins;
    GuidedWalk guided;
    TallyLayout layout;
    double guided_share = 0;                   ///< guided walks for each walk; they tally the total and its moments
    std::vector<double> guided_part;           ///< what counts of their bins, per slot of the layout; empty: nothing
    std::array<double, 2> guided_whole{1, 1};  ///< what counts of their total and x
    double x_slope = 0, r2_slope = 0;          ///< so much of their controls is taken off guided moments
    bool guided_moments = false;               ///< those of all orders do, alone
    bool counts_beyond = false;                ///< what they leave to the bins is beyond them
    std::optional<SingleScattering> single;    ///< nothing: walks tally order 1, too
};

/// The walks with expected escape and importance alone, of a plan that foresees or has no guided walks.
std::uint64_t walkForeseeingChunk(const BestPlan& plan, SplitMix64 seeds, std::uint64_t walks, ExitTally& tally);

/// As walkHalfSpaceChunk; the tally must have the plan's edges and no grid.
std::uint64_t walkBestChunk(const BestPlan& plan, std::uint64_t seed, std::uint64_t chunk, std::uint64_t walks,
                            ExitTally& tally);

}  // namespace searchlight
