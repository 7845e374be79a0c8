// How the time of the best estimator of slabs is divided between its kinds of walks.
#pragma once

#include <vector>

#include "transport/slab/slab_tally.h"

namespace searchlight {

/// Of one walk of each kind: its time in ns, and per slot the variance of what it says, relative to the square of the
/// truth; 0 where it is not known, infinite where such a walk says nothing.
struct SlabKnowledge {
    struct Kind {
        double time = 1;
        std::vector<double> variance;
    };
    Kind foreseeing;
    Kind depth, place;  ///< analogue walks with controls that know their depth alone, and their place as well
    Kind analogue;      ///< the other estimator
};

struct SlabMix {
    bool foresees = false;     ///< otherwise analogue walks with controls are all
    bool places = false;       ///< those beside walks that foresee know their places; otherwise their depth alone
    double beside = 0;         ///< so many of them for each walk that foresees
    std::vector<double> part;  ///< theirs in each slot
};

/// The mix that knows series and totals best against the analogue estimator, in the mean of logarithms; that none
/// should be known worse counts for more.
SlabMix chooseMix(const SlabLayout& layout, const SlabKnowledge& knowledge);

}  // namespace searchlight
