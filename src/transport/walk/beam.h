// How a beam is wide, and how it enters a half-space through its smooth surface.
#pragma once

#include <cmath>
#include <numbers>

#include "base/random.h"
#include "transport/walk/fresnel.h"

namespace searchlight {

struct BeamPoint {
    double x = 0, y = 0;
};

/// The cross-section of a parallel beam, across its direction.
struct BeamShape {
    enum Kind {
        pencil,
        gaussian,  ///< radius: where it has fallen to 1/e^2
        flat,      ///< even within the radius
    };
    Kind kind = pencil;
    double radius = 0;  ///< mm, or the walk's unit of length

    bool operator==(const BeamShape&) const = default;

    /// A point of the surface, (0, 0) on the axis; cosine: of incidence, outside, in the plane y = 0.
    BeamPoint draw(SplitMix64& random, double cosine) const {
        if (kind == pencil) return {};
        const double u = random.uniform(), azimuth = 2 * std::numbers::pi * random.uniform();
        const double r = radius * (kind == flat ? std::sqrt(u) : std::sqrt(-0.5 * std::log(u)));
        return {r * std::cos(azimuth) / cosine, r * std::sin(azimuth)};
    }
};

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
