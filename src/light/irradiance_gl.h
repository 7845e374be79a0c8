// Irradiance on OpenGL: the same light as in irradiance.h, with shadow maps in place of rays.
#pragma once

#include <memory>

#include "light/irradiance.h"

namespace searchlight {

namespace gl {
class Context;
}

/// All lights of a scene on points; what an occluded environment adds improves with every step. Shadows are filtered by
/// percentage of closer texels, so their edges are about two texels of a map wide: 1/1000 of the bounding sphere's
/// diameter for a light from one direction or point, 1/250 for each of the directions that a disc or an environment is
/// made of. Unshadowed parts agree with the CPU's to single precision; pictures (environments without occlusion,
/// filters) are looked up there, once per point.
class ProgressiveIrradianceGl {
public:
    /// Everything but occluded environments, which start at 0. `shadows`: the object's mesh casts them. `points` and
    /// `object` are kept; they, and the context, outlive this. Throws as ProgressiveIrradiance does, a device Error
    /// where maps do not fit the device, and a usage Error when beams of an environment are asked for.
    ProgressiveIrradianceGl(gl::Context& context, const LitPoints& points, const Scene& scene, const Object& object,
                            bool shadows, const IrradianceOptions& options, Observer& observer);
    ~ProgressiveIrradianceGl();
    ProgressiveIrradianceGl(ProgressiveIrradianceGl&&) noexcept;
    ProgressiveIrradianceGl& operator=(ProgressiveIrradianceGl&&) noexcept;

    /// Light samples so far, and whether they are as many as asked for (true from the start without occluded
    /// environments).
    int samples() const;
    bool complete() const;

    /// Adds `count` samples to each occluded environment, also beyond complete(): a shadow map each.
    void step(int count, Observer& observer);

    /// In the caller's order of points.
    Irradiance result() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// The same at once, with all of options.light_samples.
Irradiance computeIrradianceGl(gl::Context& context, const LitPoints& points, const Scene& scene, const Object& object,
                               bool shadows, const IrradianceOptions& options, Observer& observer);

}  // namespace searchlight
