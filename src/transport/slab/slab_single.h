// Light that a slab scatters exactly once, without noise.
#pragma once

#include <span>
#include <vector>

#include "transport/slab/slab_walk.h"

namespace searchlight {

/// What leaves per unit flux that entered the first layer, at normal incidence: after one collision in a layer that
/// foresees, straight, without a reflection on the way out; and without a collision, however often reflected.
struct SlabSingle {
    std::vector<double> reflected, transmitted;  ///< n + 2 values for n + 1 edges: within the first, annuli, beyond
    double R_unscattered = 0, T_unscattered = 0;
};

/// Quadrature; relative error below 1e-5 of the largest annuli. edges: ascending, mm. foresees: per layer.
SlabSingle slabSingle(const SlabWalk& walk, std::span<const double> edges, const std::vector<char>& foresees);

}  // namespace searchlight
