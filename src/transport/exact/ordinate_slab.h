// A pencil beam on plane layers without noise: discrete directions in Hankel space (docs/exact-solver.md).
#pragma once

#include <string>

#include "base/observer.h"
#include "transport/slab/slab.h"

namespace searchlight {

/// Why solveSlab() does not take a problem; empty where it does.
std::string whyNotOrdinateSlab(const SlabProblem& problem);

/// What it takes, in words.
std::string ordinateSlabsCovered();

/// R, T, R_unscattered, T_unscattered, A and A_layer of walkSlab without a walk; 50 ms. Throws an input Error for a
/// problem that it does not take.
SlabResult solveSlabTotals(const SlabProblem& problem);

/// The same, R_r and T_r; the other tallies stay empty. A standard error is here an estimate of the numerical error:
/// twice what two numbers of directions differ by, the largest of neighbouring annuli, and what the end of the
/// transform is worth. Of the options, edges_mm and threads are read; edges are 0 or from 0.05 to 1000 reduced mean
/// free paths of the layer where these are shortest. Tens of seconds of CPU. Throws as walkSlab, and an input Error for
/// a problem that it does not take.
SlabResult solveSlab(const SlabProblem& problem, const SlabOptions& options, Observer& observer);

}  // namespace searchlight
