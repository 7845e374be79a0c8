// Where in a half-space a walk is worth following.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "transport/half_space/half_space_walk.h"

namespace searchlight {

/// How much a walk at distance rho from the beam's entry and at depth z adds to the relative precision of the radial
/// bins, against a walk that has just entered. Any positive table leaves a walk with roulette and splitting unbiased;
/// this one comes from diffusion and makes it short. Lengths are in mean free paths.
struct ImportanceTable {
    /// Cells are logarithmic: two for each octave of rho^2 + offset and of z^2 + offset.
    static constexpr int kCells = 48, kMantissaBits = 1;

    double decay = 0;  ///< rate at which light dies out far from its source, per mean free path
    float offset = 1;
    std::vector<float> value;  ///< kCells x kCells, row z, column rho
};

/// For bins with these edges, ascending, in mean free paths.
ImportanceTable makeImportanceTable(const HalfSpaceWalk& walk, std::span<const double> edges);

}  // namespace searchlight
