// The kernel's own best terms: singular vectors on a grid ([Freude2014] Section 5.1).
#pragma once

#include "kernel/cells.h"

namespace searchlight {

struct SingularKernel {
    SeparableKernel raw;                                         ///< nearest of its rank to the truth in kernel space
    SeparableKernel normalised;                                  ///< scaled to mass 1, Eq. 5.12
    std::array<std::vector<double>, Rgb::channels> eigenvalues;  ///< by descending magnitude, of the terms
};

/// The first `rank` terms (1 to the number of cells along the half-axis). Eigenvalues of an even kernel that is not
/// positive may be negative: the sign is in a term's scale. By subspace iteration, which costs the few largest terms
/// and no more.
SingularKernel singularKernel(const CellKernel& truth, int rank);

}  // namespace searchlight
