// Radial bins as float lanes find them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace searchlight {

/// RadialBins for float lanes: the same slots, edges rounded to float.
struct LaneBins {
    int shift = 0;  ///< a cell of the table is a run of floats that share their bits above
    std::int32_t first_cell = 0;
    std::int32_t steps = 0;                ///< the most edges within one cell
    std::vector<std::int32_t> first_slot;  ///< per cell: the lowest slot that meets it
    std::vector<float> next_edge;          ///< per slot: the squared edge that ends it; infinity for the last
    float per_length = 0;                  ///< of bins that are all alike and begin at 0; otherwise 0
};

/// For edges as RadialBins takes them.
LaneBins laneBins(std::span<const double> edges);

}  // namespace searchlight
