// Analytic pre-integration: a(x) is R_d integrated along y ([Freude2014] Eq. 5.17), exact for E1(x) + E2(y).
#pragma once

#include "kernel/ground_truth.h"
#include "kernel/kernel.h"

namespace searchlight {

/// By two integrals in one dimension; no grid is summed. Energy of the profile is kept to rounding.
SeparableKernel preintegrated(const GroundTruth& truth);

/// The lines of it.
std::array<LineKernel, Rgb::channels> lineSpread(const GroundTruth& truth);

}  // namespace searchlight
