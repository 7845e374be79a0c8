// Light scattered exactly once, without noise.
#pragma once

#include <span>
#include <vector>

#include "transport/half_space/half_space_walk.h"

namespace searchlight {

/// What leaves after one collision, per unit flux that entered. Lengths are in mean free paths.
struct SingleScattering {
    double total = 0;
    double x = 0;              ///< flux times the shift along the beam
    double r2 = 0;             ///< flux times squared radius
    std::vector<double> flux;  ///< n + 2 values for n edges + 1: below the first edge, each annulus, beyond the last
    double error = 1e-9;       ///< of them all, over the total; more than 1e-7 where that takes too many azimuths
};

/// Quadrature. edges: ascending.
SingleScattering singleScattering(const HalfSpaceWalk& walk, std::span<const double> edges);

}  // namespace searchlight
