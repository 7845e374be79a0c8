#include "render/stages_gl.h"

#include "light/irradiance_gl.h"

namespace searchlight {

Irradiance StagesGl::irradiance(const SurfacePoints& points, std::uint64_t points_version, const Scene& scene,
                                const Object& object, const RayScene& rays, const IrradianceOptions& options,
                                Observer& observer) {
    if (!points_ || points_version != points_version_) {
        points_.reset();
        lit_ = prepareLitPoints(points, object, &rays, options.normals, options.threads, observer);
        points_.emplace(context_, lit_, object, true);
        points_version_ = points_version;
    }
    return computeIrradianceGl(*points_, scene, options, observer);
}

VisibleSurface StagesGl::visible(const View& view, const Object& object, std::uint64_t object_version,
                                 const TraceOptions& options, Observer& observer) {
    if (!visible_ || object_version != object_version_) {
        visible_.emplace(context_, object);
        object_version_ = object_version;
    }
    return visible_->visible(view, options, observer);
}

}  // namespace searchlight
