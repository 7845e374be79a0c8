// The stages of a picture before the sum on OpenGL, with what they keep on the device.
#pragma once

#include <cstdint>
#include <optional>

#include "light/irradiance.h"
#include "light/lit_points_gl.h"
#include "render/view.h"
#include "render/visible_gl.h"

namespace searchlight {

/// What changed is brought to the device again, and nothing else: objects and points have a version that their owner
/// counts up. Throws as computeIrradianceGl() and VisibleGl do.
class StagesGl {
public:
    /// The context outlives it.
    explicit StagesGl(gl::Context& context) : context_(context) {}

    /// computeIrradianceGl() on `points`; the object, which casts the shadows, stays alive until its version changes.
    /// `rays` of the object find out where points lie on it.
    Irradiance irradiance(const SurfacePoints& points, std::uint64_t points_version, const Scene& scene,
                          const Object& object, const RayScene& rays, const IrradianceOptions& options,
                          Observer& observer);

    /// VisibleGl::visible().
    VisibleSurface visible(const View& view, const Object& object, std::uint64_t object_version,
                           const TraceOptions& options, Observer& observer);

private:
    gl::Context& context_;
    LitPoints lit_;
    std::optional<LitPointsGl> points_;
    std::optional<VisibleGl> visible_;
    std::uint64_t points_version_ = 0, object_version_ = 0;
};

}  // namespace searchlight
