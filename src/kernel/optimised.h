// Taps found for the smallest error of pictures, offsets and weights together: what kernel space cannot promise.
#pragma once

#include "kernel/ground_truth.h"
#include "kernel/kernel.h"

namespace searchlight {

struct OptimisedOptions {
    int taps = 17;          ///< per pass: odd, at least 3
    int rank = 1;           ///< 1, or 2: a second pair of passes, along the diagonals
    double feature_mm = 0;  ///< edges are about this far apart; 0: 16 half-energy radii of the middle channel
    /// For axes that turn from pixel to pixel (rank 1): light takes its two steps at angles that are as good as
    /// independent, so that on average the kernel is the line's mean over all angles, twice. Its transform is
    /// (sum of w J0(omega x))^2, which can be that of any radial kernel: no cross is left, only grain.
    bool turned = false;
    int max_steps = 40;
};

struct OptimisedTaps {
    Taps taps;
    double start = 0, error = 0;  ///< the expected error, before and after, over all three channels
    int steps = 0;
};

/// Minimises the expected mean square error of pictures made of edges in all directions, and of discs, whose power
/// falls as the third power of the frequency: the sum over frequencies of power times |truth - taps|^2. No picture is
/// used. Weights are not negative, and each channel keeps its energy to rounding. Gauss and Newton, damped, from
/// quadratic offsets of several extents.
OptimisedTaps optimisedTaps(const GroundTruth& truth, const OptimisedOptions& options = {});

/// Offsets and weights that come nearest to the lines of a given kernel under the same measure in one dimension: where
/// to put a few taps of any method. Terms have offsets of their own; those of a mass of 0 are left quadratic.
Taps placedTaps(const SeparableKernel& kernel, int taps);

}  // namespace searchlight
