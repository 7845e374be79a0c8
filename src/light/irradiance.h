// Light on the points of a surface, after it crossed into the medium.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "base/observer.h"
#include "base/vec.h"
#include "geometry/object.h"
#include "geometry/rays.h"
#include "light/lit_points.h"
#include "scene/scene.h"

namespace searchlight {

/// Parallel light, or the light of one point of the scene, on every surface point: what models that read wi need.
struct Beam {
    std::vector<Vec3f> wi;   ///< towards the light, unit: one for all points, or one per point
    std::vector<Rgbf> flux;  ///< T12(wi) times irradiance, per point, per mm^2; 0 in shadow
};

/// Flux per mm^2 that crossed into the medium: the integral of T12(wi) L(wi) cos over the hemisphere, with T12 exact.
/// An irradiance has the unit that the scene's lights are given in.
struct Irradiance {
    std::vector<Rgbf> transmitted;  ///< one per point
    std::vector<Beam> beams;        ///< add up to `transmitted`; empty unless asked for
};

struct IrradianceOptions {
    double eta = 1.3;
    LitNormals normals = LitNormals::shading;
    bool beams = false;  ///< also as beams
    int beam_count =
        16;  ///< of those that one environment becomes [Frisvad2014, sec. 4], at least 1; one more for the rest
    int light_samples = 4096;  ///< directions by which an occluded environment is summed, shared by all points
    int disc_samples = 64;     ///< directions by which a light with an angle is summed; a quarter where they agree
    std::uint64_t seed = 1;
    int threads = 0;
};

/// All lights of a scene on points; what an occluded environment adds improves with every step.
class ProgressiveIrradiance {
public:
    /// Everything but occluded environments, which start at 0. `points` and `rays` (the object in place; null: nothing
    /// casts shadows) are kept and must outlive this; points must have been prepared with options.normals. Paths of
    /// pictures are opened here. Throws an input Error for a picture that cannot be used, interruptedError() when
    /// cancelled.
    ProgressiveIrradiance(const LitPoints& points, const Scene& scene, const Object& object, const RayScene* rays,
                          const IrradianceOptions& options, Observer& observer);
    ~ProgressiveIrradiance();
    ProgressiveIrradiance(ProgressiveIrradiance&&) noexcept;
    ProgressiveIrradiance& operator=(ProgressiveIrradiance&&) noexcept;

    /// Light samples so far, and whether they are as many as asked for (true from the start without occluded
    /// environments).
    int samples() const;
    bool complete() const;

    /// Adds `count` samples (256 or another power of two keeps them well spread) to each occluded environment, also
    /// beyond complete(). The outcome depends neither on threads nor on how samples are cut into steps. When cancelled
    /// it throws and stays as it was.
    void step(int count, Observer& observer);

    /// In the caller's order of points. Unbiased over the seeds after any number of samples but 0.
    Irradiance result() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// The same at once, with all of options.light_samples.
Irradiance computeIrradiance(const LitPoints& points, const Scene& scene, const Object& object, const RayScene* rays,
                             const IrradianceOptions& options, Observer& observer);

/// Prepares the points first: for one light only.
Irradiance computeIrradiance(const SurfacePoints& points, const Scene& scene, const Object& object,
                             const RayScene* rays, const IrradianceOptions& options, Observer& observer);

}  // namespace searchlight
