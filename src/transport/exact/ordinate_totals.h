// What a slab reflects, transmits and absorbs, and into which angles, without noise.
#pragma once

#include <string>

#include "transport/slab/slab.h"

namespace searchlight {

/// Why solveSlabTotals() does not take a problem; empty where it does.
std::string whyNotOrdinateTotals(const SlabProblem& problem);

/// Totals, A of each layer and means of R and T over equal parts of 90 degrees, of a beam of any width at any angle of
/// incidence, by discrete directions; some 10 ms a layer. A standard error estimates the numerical error: the
/// difference between two numbers of directions, doubled. Throws an input Error for a problem that it does not take.
SlabResult solveSlabTotals(const SlabProblem& problem, int angles = 30);

}  // namespace searchlight
