// The low-variance walk through plane layers: what half_space_best.h is to the half-space.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "base/random.h"
#include "transport/slab/slab_control.h"
#include "transport/slab/slab_depths.h"
#include "transport/slab/slab_importance.h"
#include "transport/slab/slab_lead.h"
#include "transport/slab/slab_mix.h"
#include "transport/slab/slab_pilot.h"
#include "transport/slab/slab_single.h"
#include "transport/slab/slab_tally.h"
#include "transport/slab/slab_walk.h"
#include "transport/walk/lane_bins.h"

namespace searchlight {

/// What one chunk of these walks found, in sums over walks; without what the plan knows beforehand.
struct SlabBestSums {
    std::vector<double> single, multiple;            ///< reflected, per radial slot
    std::vector<double> transmitted;                 ///< per radial slot
    std::vector<double> reflected_a, transmitted_a;  ///< per angle
    std::vector<double> collided;                    ///< weight that came to collisions, per slot of SlabDepths
    std::uint64_t collisions = 0;
    std::uint64_t steps = 0;  ///< to collisions and to interfaces
};

/// What part of R and T each angle has, and what part of its layer each slot of depth, roughly: where walks that
/// foresee find more in all than analogue walks with their controls, so much of it is taken back, as far as these know
/// the whole better: each is times the part that the analogue walks have in the best mix of both.
struct SlabShape {
    std::vector<double> reflected_a, transmitted_a, collided;
};

/// What all chunks of a job share.
struct SlabBestPlan {
    /// edges: of the annuli, mm. layout: what is tallied; both and the walk outlive the plan.
    SlabBestPlan(const SlabWalk& walk, std::span<const double> edges, const SlabLayout& layout);

    const SlabWalk& walk;
    const SlabLayout& layout;
    SlabControl control;
    SlabDepths depths;
    SlabPilot pilot;
    LaneBins bins;
    SlabImportance importance;
    std::optional<SlabSingle> single;  ///< of a pencil at normal incidence; otherwise walks tally order 1, too
    std::vector<char> foresees;  ///< per layer: its collisions tally expected escapes; otherwise what leaves the slab

    bool absorbs = false;
    double controlled = 1;  ///< where analogue walks are alone: those that tell controls
    SlabMix mix;
    /// Of what R, T, A and unscattered light lack of the whole: the parts that R, T and A get, 1 in sum.
    std::array<double, 3> missing{};
    SlabShape shape;
    /// Through an opaque slab T, T(r) and T(angle) come from walks that are led, and A(z) where it is deep.
    std::optional<SlabLead> lead;

private:
    bool isotropic() const;
    double controlTime() const;
    double analogueTime() const;
    double besideTime(bool places) const;
    double foreseeingTime(std::uint64_t steps) const;
    void planShape(const std::vector<SlabBestSums>& chunks, double time);
    SlabKnowledge knowledgeOf(const BatchRatios& best, double time) const;
    void copyParts();
    void planLead(double time);
};

/// The walks with expected escape and importance alone; led through the slab, or null.
SlabBestSums walkForeseeingSlabChunk(const SlabBestPlan& plan, SplitMix64 seeds, std::uint64_t walks,
                                     const SlabLead* lead = nullptr);

/// As walkSlabChunk; the tally must have the plan's layout.
std::uint64_t walkSlabBestChunk(const SlabBestPlan& plan, std::uint64_t seed, std::uint64_t chunk, std::uint64_t walks,
                                SlabTally& tally);

}  // namespace searchlight
