// A pencil beam on plane layers without noise: discrete directions in Hankel space (docs/exact-solver.md).
#pragma once

#include <string>

#include "base/observer.h"
#include "transport/slab/slab.h"

namespace searchlight {

/// Why solveSlab() does not take a problem; empty where it does.
std::string whyNotOrdinateSlab(const SlabProblem& problem);

/// What it and solveSlabTotals() take, in words.
std::string ordinateSlabsCovered();

/// solveSlabTotals(), R_r and T_r; the other tallies stay empty. A standard error is here an estimate of the numerical
/// error: twice what two numbers of directions differ by, the largest of neighbouring annuli, and what the end of the
/// transform is worth. Of the options, edges_mm, angles and threads are read; edges are 0 or from 0.05 to 1000 reduced
/// mean free paths of the layer where these are shortest. Tens of seconds of CPU. Throws as walkSlab, and an input
/// Error for a problem that it does not take.
SlabResult solveSlab(const SlabProblem& problem, const SlabOptions& options, Observer& observer);

/// Mean squared exit radius of what is reflected, mm^2, of a problem that solveSlab() takes; finite with absorption or
/// a lower surface.
Estimate slabMeanR2(const SlabProblem& problem);

}  // namespace searchlight
