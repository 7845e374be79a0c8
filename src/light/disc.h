// The disc in the sky that a directional light with an angle is.
#pragma once

#include "base/vec.h"
#include "scene/scene.h"

namespace searchlight {

/// Uniform radiance within half of angle_deg of the direction; a single direction where the angle is 0.
class Disc {
public:
    explicit Disc(const DirectionalLight& light);

    /// Uniform in solid angle for two uniform numbers in [0, 1); unit.
    Vec3 sample(double u, double v) const;

    /// 1/pdf of sample(); 0 for a single direction.
    double solidAngle() const;

    /// What the mean over sample() of a quantity has to be multiplied by to be its integral against the radiance of a
    /// disc whose irradiance, on a surface that faces it, is 1.
    double weight() const;

    /// Whether the disc is seen in a unit direction; a single direction is not.
    bool holds(Vec3 direction) const;

private:
    Vec3 centre_, tangent_, bitangent_;
    double versine_ = 0;  ///< 1 - cos of the disc's radius
};

}  // namespace searchlight
