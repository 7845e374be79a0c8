// Where the bins of depth lie in plane layers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "transport/slab/slab_tally.h"
#include "transport/slab/slab_walk.h"

namespace searchlight {

/// Bins of depth that each layer meets, one after another.
struct SlabDepths {
    SlabDepths(const SlabWalk& walk, const SlabLayout& layout);

    struct Layer {
        float top = 0;              ///< in bins
        float first = 0, last = 0;  ///< bins
        std::int32_t slot = 0;      ///< that of the first bin, less the bin
    };
    std::vector<Layer> layers;
    float per_mm = 1;
    struct Slot {
        std::size_t layer = 0, depth = 0;
    };
    std::vector<Slot> slots;
};

}  // namespace searchlight
