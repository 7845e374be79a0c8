// How walks are led through a slab that hardly any light passes.
#pragma once

#include <vector>

#include "transport/slab/slab_importance.h"
#include "transport/slab/slab_walk.h"

namespace searchlight {

/// Flights along the cosine w (positive downwards) end at the rate 1 - rate w, for each of the medium: so weights fall
/// with depth as exp(-rate z), nearly as light does, and every other walk gets through: the exponential transform of
/// shielding calculations. Their importance makes up for that.
struct SlabLead {
    std::vector<float> rate;  ///< per layer and mean free path, below 1
    SlabImportance importance;

    double share = 0;  ///< walks that are led for each other one
    /// Per slot of the tally: their part in what is known, and what one of them brings there, roughly.
    std::vector<double> part, event;
};

/// For a slab with a lower side.
SlabLead leadThrough(const SlabWalk& walk);

}  // namespace searchlight
