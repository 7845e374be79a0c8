// The searchlight problem without noise where there is no closed form: Henyey-Greenstein scattering, a Fresnel surface.
#pragma once

#include <string>
#include <vector>

#include "base/observer.h"
#include "transport/exact/exact_half_space.h"

namespace searchlight {

/// Why solveOrdinates() does not take a problem; empty where it does.
std::string whyNotOrdinates(const HalfSpaceProblem& problem);

/// Solves by discrete directions in Hankel space, per unit incident flux; seconds of CPU. Errors are those between two
/// numbers of directions, doubled. Throws an input Error for a problem that it does not take, interruptedError() when
/// the observer cancels. threads: 0: all; they do not change the result.
ExactHalfSpace solveOrdinates(const HalfSpaceProblem& problem, int threads, Observer& observer);

/// Why solveAnyHalfSpace() does not take a problem; empty where it does.
std::string whyNotExactHalfSpace(const HalfSpaceProblem& problem);

/// The tallies of walkHalfSpace without a walk: solveHalfSpace() where there is a closed form, solveOrdinates() where
/// this knows the problem, else solveSlab() of one infinite layer. Edges above 0 are at least the smallest radius.
/// Throws as these do, and for edges.
HalfSpaceResult solveAnyHalfSpace(const HalfSpaceProblem& problem, const std::vector<double>& edges_mm, int threads,
                                  Observer& observer);

}  // namespace searchlight
