// The phase function of [HenyeyGreenstein1941], in double precision.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/directions.h"
#include "base/random.h"

namespace searchlight {

/// Cosine of a scattering angle by inversion, s uniform in [-1, 1]. Without differences of near numbers for g near 0.
inline double henyeyGreensteinCosine(double g, double s) {
    const double p = 1 + g * s;
    return std::max(-1.0, 1 - 0.5 * (1 - g) * (1 - g) * (1 - s) * (1 + g + p) / (p * p));
}

/// Where a collision sends light of this unit direction.
inline Vec3 scatteredDirection(Vec3 direction, double g, SplitMix64& random) {
    const double cosine = henyeyGreensteinCosine(g, 2 * random.uniform() - 1);
    return directionAround(direction, cosine, 2 * std::numbers::pi * random.uniform());
}

}  // namespace searchlight
