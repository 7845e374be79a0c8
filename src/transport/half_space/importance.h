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
    float ahead = 0;           ///< a walk is as important as one so far along its direction
    std::vector<float> value;  ///< kCells x kCells, row z, column rho
};

/// What is chosen rather than derived; bench/tuning_bench measures what other choices are worth.
struct BestTuning {
    double roulette = 0.8;  ///< weight times importance below meets it
    double far = 0.4;       ///< rings count by this power of their radius: what is far is harder to know
    double total = 0.01;    ///< what the total counts beside the rings
    double depth = 0.25;    ///< a walk is as important as a source so far below it, in reduced mean free paths
    double ahead = 0.6;     ///< of the way that a walk still goes along its direction, on average
    double shallow = 0;     ///< so many times as important at the surface, besides
    double stretched = 0;   ///< part of the flights that are drawn longer
};

/// What serves a medium best.
BestTuning tuningFor(const HalfSpaceWalk& walk);

/// For bins with these edges, ascending, in mean free paths.
ImportanceTable makeImportanceTable(const HalfSpaceWalk& walk, std::span<const double> edges, const BestTuning& tuning);

}  // namespace searchlight
