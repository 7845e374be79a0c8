// A line found by weighted least squares in kernel space ([Freude2014] Section 5.3).
#pragma once

#include "kernel/cells.h"

namespace searchlight {

/// A factor at which the mass of the five materials of [Freude2014] is off by up to 29 %.
inline constexpr double kThesisSoftness = 0.1;

struct GuidedOptions {
    double k = 1;  ///< of the guide function: 0 favours the middle, 2 the far field
    double b = 0;  ///< > 0: less weight near the axes, per square of the extent
    /// The thesis adds (1 - mass)^2 to the objective instead of demanding mass 1; this is its factor, relative to the
    /// objective of the kernel 0. 0: demand it.
    double soft = 0;
    int max_steps = 200;
};

struct GuidedKernel {
    SeparableKernel kernel;
    std::array<int, Rgb::channels> steps{};  ///< of Newton's method
    Rgb mass;                                ///< of the kernel: 1 unless the constraint is soft
};

/// a >= 0 that minimises the sum over cells of Gamma (R_d - a(x) a(y))^2, Eq. 5.19 and 5.20, from `start`'s first term:
/// Gauss and Newton with the constraint as a multiplier, exact to rounding.
GuidedKernel guidedKernel(const CellKernel& truth, const SeparableKernel& start, const GuidedOptions& options = {});

}  // namespace searchlight
