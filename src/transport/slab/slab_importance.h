// Where in plane layers a walk is worth following.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "transport/slab/slab_walk.h"

namespace searchlight {

/// As ImportanceTable: how much a walk adds to the relative precision of the annuli on both sides, against one that has
/// just entered. Any positive table will do; this one is that of diffusion in one slab of the layers' mean properties.
struct SlabImportance {
    /// Columns are logarithmic: two for each octave of rho^2 + offset.
    static constexpr int kColumns = 28, kMantissaBits = 1;

    struct Layer {
        float rows_per_mm = 0;
        std::int32_t first_row = 0, rows = 1;
    };
    std::vector<Layer> layers;
    float offset = 1;          ///< mm^2
    std::vector<float> value;  ///< row by row
};

/// Rate at which light dies out in a layer, per mean free path.
double decayPerMfp(const SlabWalk::Layer& layer);

/// Whether a slab is so thick, counted in the decay of its light, that this importance leads no walk through it.
bool isOpaque(const SlabWalk& walk);

/// For annuli with these edges, mm.
SlabImportance makeSlabImportance(const SlabWalk& walk, std::span<const double> edges);

}  // namespace searchlight
