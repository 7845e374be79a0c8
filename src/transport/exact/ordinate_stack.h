// Transport of one transverse frequency through plane layers, by discrete directions and doubling
// (docs/exact-solver.md).
#pragma once

#include <complex>
#include <vector>

#include "transport/exact/ordinate_orders.h"

namespace searchlight {

/// Hankel transforms, at k = i rate, of what is scattered and leaves, as `count` directions have it; per unit flux that
/// entered. The rate has a real part from 0 to below that of the slowest lateral decay of light.
StackFlux stackExitance(const OrdinateStack& stack, const StackCount& count, std::complex<double> rate);

/// The same but for what is scattered once and then goes straight; with the second order of many directions.
StackFlux stackTransform(const OrdinateStack& stack, const StackCount& count, std::complex<double> rate);

/// Everything that is scattered, at k = 0, for a beam at any angle. The beam is that of the stack.
struct StackTotals {
    double R = 0, T = 0;
    std::vector<double> absorbed;  ///< in each layer, of the unscattered beam as well
    std::vector<double> R_a, T_a;  ///< of R and T, what leaves in equal parts of 90 degrees outside
};
StackTotals stackTotals(const OrdinateStack& stack, int cosines, int angles);

}  // namespace searchlight
