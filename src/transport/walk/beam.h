// How a beam enters a half-space through its smooth surface.
#pragma once

#include <cmath>
#include <numbers>

#include "transport/walk/fresnel.h"

namespace searchlight {

struct Beam {
    double specular = 0;          ///< Fresnel reflectance, unpolarised; 1 beyond the critical angle of a thinner medium
    double sine = 0, cosine = 1;  ///< of the refracted direction; meaningless when nothing enters
};

/// eta: inside over outside; angle_deg in [0, 90).
inline Beam enteringBeam(double eta, double angle_deg) {
    const double angle = angle_deg * (std::numbers::pi / 180);
    const double cosine = std::cos(angle), sine = std::sin(angle) / eta;
    if (eta == 1) return {0, sine, cosine};
    if (sine >= 1) return {1, 1, 0};
    const double refracted = std::sqrt((1 - sine) * (1 + sine));
    return {fresnelReflectance(1, cosine, eta, refracted), sine, refracted};
}

}  // namespace searchlight
