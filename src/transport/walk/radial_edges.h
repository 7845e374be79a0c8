// Edges of the radial bins of a tally.
#pragma once

#include <vector>

#include "transport/half_space/half_space.h"

namespace searchlight {

/// `bins` annuli of equal width from 0 to max_mm: bins + 1 edges. Throws an input Error unless both are positive.
std::vector<double> linearEdges(int bins, double max_mm);

/// `bins` annuli from 0 to where about 0.1 % has not yet left; widths grow with the radius (edges are equally spaced in
/// its root), because the profile is steepest at the entry point.
std::vector<double> defaultEdges(const HalfSpaceProblem& problem, int bins = 50);

}  // namespace searchlight
