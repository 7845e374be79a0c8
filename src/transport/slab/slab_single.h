// Light that a slab scatters exactly once, without noise.
#pragma once

#include <span>
#include <vector>

#include "transport/slab/slab_walk.h"

namespace searchlight {

/// Light that has not met a scatterer, per unit flux that entered the first layer, with all reflections between the
/// interfaces; exact at any angle of incidence, and for beams of any width.
struct SlabUnscattered {
    std::vector<double> down, up;  ///< per layer: enters it at its top, at its bottom
    std::vector<double> cosine;    ///< per layer; where no light gets the others are meaningless
    double R = 0, T = 0;           ///< leaves above, below

    /// Reaches a collision in this layer between two depths from its top, mm.
    double collides(const SlabWalk::Layer& layer, std::size_t index, double from_mm, double to_mm) const;
};

SlabUnscattered slabUnscattered(const SlabWalk& walk);

/// What leaves per unit flux that entered the first layer, at normal incidence, after one collision in a layer that
/// foresees, straight, without a reflection on the way out.
struct SlabSingle {
    std::vector<double> reflected, transmitted;      ///< n + 2 values for n + 1 edges: within the first, annuli, beyond
    std::vector<double> reflected_a, transmitted_a;  ///< over equal parts of 90 degrees, outside; none for 0 angles
};

/// Quadrature; relative error below 1e-5 of the largest annuli. edges: ascending, mm. foresees: per layer.
SlabSingle slabSingle(const SlabWalk& walk, std::span<const double> edges, const std::vector<char>& foresees,
                      std::size_t angles);

}  // namespace searchlight
