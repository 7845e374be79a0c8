// A kernel as a few samples.
#pragma once

#include <vector>

#include "kernel/kernel.h"

namespace searchlight {

/// Offsets of `count` taps (odd, at least 3), the largest at extent_mm, dense at the middle: extent (i / side)^2, as
/// the original shader has them. Ascending and symmetric.
std::vector<double> quadraticOffsets(int count, double extent_mm);

/// Samples every term at these offsets: a weight is the integral of the line over the cell between the middles of
/// neighbours, and the outermost cells reach to the end of the line: no mass is lost, and none has to be scaled away.
/// Requires a list like quadraticOffsets'.
Taps sampleTaps(const SeparableKernel& kernel, const std::vector<double>& offsets_mm);

/// The same with quadratic offsets for each term, up to where `rest` of it lies beyond: tapExtent.
Taps quadraticTaps(const SeparableKernel& kernel, int count, double rest = 0.01);

/// A radius that the outermost of `count` taps may stand at: beyond it lies at most `rest` of the absolute mass of each
/// line.
double tapExtent(const SeparableKernel& kernel, double rest = 0.01);

}  // namespace searchlight
