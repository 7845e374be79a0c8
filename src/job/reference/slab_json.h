// The numbers of a slab, for the commands that walk one.
#pragma once

#include <string>

#include "job/json.h"
#include "transport/slab/slab.h"

namespace searchlight {

/// Problem, totals, series and (if walked for) maps; every number with its standard error.
Json slabJson(const SlabProblem& problem, const SlabOptions& options, const SlabResult& result);

/// The totals as lines for people.
std::string slabText(const SlabProblem& problem, const SlabResult& result);

/// The same of a slab that was solved: those numbers that solveSlab() or solveSlabTotals() gives.
Json exactSlabJson(const SlabProblem& problem, const SlabOptions& options, const SlabResult& result);
std::string exactSlabText(const SlabProblem& problem, const SlabResult& result);

}  // namespace searchlight
