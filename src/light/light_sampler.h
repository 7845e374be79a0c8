// One direction at a time from all lights of a scene, for walks that are lit at random points of a surface.
#pragma once

#include <cstddef>
#include <limits>
#include <memory>

#include "base/vec.h"
#include "geometry/object.h"
#include "scene/scene.h"

namespace searchlight {

struct LightSample {
    Vec3 wi;                  ///< towards the light, unit
    Rgb irradiance_over_pdf;  ///< on a surface that faces wi, over the probability of having chosen it; 0: no light
    /// Per solid angle, that of having chosen this light included; 0 for light from a single direction.
    double pdf = 0;
    double distance = std::numeric_limits<double>::infinity();  ///< to the light, mm
};

/// Chooses a light by the luminance that it brings to the object's centre, then a direction within it: by importance in
/// an environment, uniformly in a disc. Shadow rays are the caller's, and so are T12(wi) and the cosine: the
/// expectation of irradiance_over_pdf T12(wi) max(0, cos) visibility is what computeIrradiance() computes. Immutable;
/// all queries may run on many threads at once.
class LightSampler {
public:
    /// Opens the pictures of the scene. Throws an input Error for one that cannot be used.
    LightSampler(const Scene& scene, const Object& object);
    ~LightSampler();
    LightSampler(LightSampler&&) noexcept;
    LightSampler& operator=(LightSampler&&) noexcept;

    /// At `position` (mm) for three uniform numbers in [0, 1).
    LightSample sample(Vec3 position, double u_light, double u, double v) const;

    /// Lights that emit, and the same of one of them alone.
    std::size_t count() const;
    LightSample sampleOf(std::size_t light, Vec3 position, double u, double v) const;
    /// Whether a light comes from a single direction at each point.
    bool singular(std::size_t light) const;

    /// Whether a light is a disc of at most 40 degrees, which directions that are drawn otherwise meet rarely.
    bool narrow(std::size_t light) const;

    /// What comes to `position` (mm) from a unit direction, of lights that have an extent: the mean of sample() over
    /// directions, where it is not from a single one. `wide_only`: without narrow() lights.
    Rgb radiance(Vec3 position, Vec3 direction, bool wide_only = false) const;

    /// Whether some light comes from a single direction at each point: no walk ever meets it.
    bool singular() const;
    bool narrow() const;  ///< whether some light is

    /// True when the scene has no light, or none that emits.
    bool dark() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace searchlight
