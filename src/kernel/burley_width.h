// The one number that engines with normalized diffusion want.
#pragma once

#include "kernel/ground_truth.h"

namespace searchlight {

/// d per channel, mm, of (exp(-r/d) + exp(-r/3d)) / (8 pi d r) that comes nearest to the truth in pictures: under power
/// that falls as the third power of the frequency. 0 for a channel that does not scatter.
Rgb burleyWidth(const GroundTruth& truth);

/// Its transform at omega, 1/mm: (1 / sqrt(1 + (omega d)^2) + 3 / sqrt(1 + 9 (omega d)^2)) / 4.
double burleyTransform(double d_mm, double omega);

}  // namespace searchlight
