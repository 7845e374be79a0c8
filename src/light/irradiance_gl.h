// Irradiance on OpenGL: the same light as in irradiance.h, with shadow maps in place of rays.
#pragma once

#include <memory>

#include "light/irradiance.h"

namespace searchlight {

namespace gl {
class Context;
}
class LitPointsGl;

/// All lights of a scene on points; what an occluded environment adds improves with every step. Shadows are filtered by
/// percentage of closer texels, so their edges are about two texels of a map wide: 1/1000 of the bounding sphere's
/// diameter for a light from one direction or point and for each beam of an environment, 1/250 for each of the
/// directions by which a disc or an environment is summed. Unshadowed parts agree with the CPU's to single precision;
/// pictures (environments without occlusion, filters) are looked up there, once per point.
class ProgressiveIrradianceGl {
public:
    /// Everything but occluded environments, which start at 0. `points` are kept and outlive this. Throws as
    /// ProgressiveIrradiance does, and a device Error where maps do not fit the device.
    ProgressiveIrradianceGl(LitPointsGl& points, const Scene& scene, const IrradianceOptions& options,
                            Observer& observer);
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
Irradiance computeIrradianceGl(LitPointsGl& points, const Scene& scene, const IrradianceOptions& options,
                               Observer& observer);

/// Brings points and object to the device first: for one light only. `shadows`: the object's mesh casts them.
Irradiance computeIrradianceGl(gl::Context& context, const LitPoints& points, const Scene& scene, const Object& object,
                               bool shadows, const IrradianceOptions& options, Observer& observer);

}  // namespace searchlight
