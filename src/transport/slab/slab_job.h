// A chunk of walks through plane layers, as those who walk it are told.
#pragma once

#include <cstdint>
#include <span>

#include "base/random.h"
#include "transport/slab/slab_control.h"
#include "transport/slab/slab_depths.h"
#include "transport/slab/slab_tally.h"
#include "transport/slab/slab_walk.h"

namespace searchlight {

/// control: null, or what to add up beside the tally; depths: null, or these walks know their depth alone; crossings:
/// null, or to this is added how often they met an interface.
struct SlabJob {
    const SlabWalk& walk;
    std::uint64_t walks;
    SlabTally& tally;
    const SlabControl* control = nullptr;
    std::span<double> sums = {};
    const SlabDepths* depths = nullptr;
    std::uint64_t* crossings = nullptr;
};

/// All walks of a job; returns the number of collisions. Compiled apart: walks that know their place, those that know
/// their depth alone, and both where phase functions are tables.
std::uint64_t walkSlabPlaces(const SlabJob& job, SplitMix64 seeds);
std::uint64_t walkSlabDepths(const SlabJob& job, SplitMix64 seeds);
std::uint64_t walkSlabTables(const SlabJob& job, SplitMix64 seeds);

}  // namespace searchlight
