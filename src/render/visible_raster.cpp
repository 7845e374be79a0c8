#include "render/visible_raster.h"

#include "render/visible/gather.h"
#include "render/visible/raster.h"

namespace searchlight {

struct VisibleRaster::Impl {
    Raster raster;
    SurfaceGatherer gatherer;
};

VisibleRaster::VisibleRaster() : impl_(std::make_unique<Impl>()) {}
VisibleRaster::~VisibleRaster() = default;

void VisibleRaster::find(const View& view, const Object& object, const TraceOptions& options, Observer& observer,
                         VisibleSurface& visible) {
    impl_->raster.draw(view, object.mesh, options);
    impl_->gatherer.gather(view, object.mesh, impl_->raster, options, observer, visible);
}

}  // namespace searchlight
