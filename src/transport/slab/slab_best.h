// The low-variance walk through plane layers: what half_space_best.h is to the half-space.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "transport/slab/slab_importance.h"
#include "transport/slab/slab_single.h"
#include "transport/slab/slab_tally.h"
#include "transport/slab/slab_walk.h"
#include "transport/walk/lane_bins.h"
#include "transport/walk/random.h"

namespace searchlight {

/// What one chunk of these walks found, in sums over walks; without what SlabBestPlan::single holds.
struct SlabBestSums {
    std::vector<double> single, multiple;  ///< reflected, per radial slot
    std::vector<double> transmitted;       ///< per radial slot
    double R_unscattered = 0, T_unscattered = 0;
    std::uint64_t collisions = 0;
    std::uint64_t steps = 0;  ///< to collisions and to interfaces
};

/// Whether these walks can serve the slab. A phase function that is a table is not known point by point; clear layers
/// carry light far away, where an importance from diffusion does harm.
bool bestServes(const SlabWalk& walk);

/// What all chunks of a job share.
struct SlabBestPlan {
    /// edges: of the annuli, mm. layout: what is tallied; both and the walk outlive the plan.
    SlabBestPlan(const SlabWalk& walk, std::span<const double> edges, const SlabLayout& layout);

    const SlabWalk& walk;
    const SlabLayout& layout;
    LaneBins bins;
    SlabImportance importance;
    std::optional<SlabSingle> single;  ///< of a pencil at normal incidence; otherwise walks tally order 1, too
    std::vector<char> foresees;  ///< per layer: its collisions tally expected escapes; otherwise what leaves the slab

    bool absorbs = false;
    bool worthwhile = false;  ///< a pilot found that R(r) is known better than by analogue walks in the same time
    /// Analogue walks for each walk. They count angles and where light is absorbed, and have a part in the rest, which
    /// the pilot chooses.
    double beside = 0;
    double part_totals = 0, part_R_r = 0, part_T_r = 0;
};

/// The walks with expected escape and importance alone.
SlabBestSums walkForeseeingSlabChunk(const SlabBestPlan& plan, SplitMix64 seeds, std::uint64_t walks);

/// As walkSlabChunk; the tally must have the plan's layout.
std::uint64_t walkSlabBestChunk(const SlabBestPlan& plan, std::uint64_t seed, std::uint64_t chunk, std::uint64_t walks,
                                SlabTally& tally);

}  // namespace searchlight
