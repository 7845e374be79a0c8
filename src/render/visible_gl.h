// What the camera sees, by rasterising instead of tracing.
#pragma once

#include "gl/buffer.h"
#include "gl/raster_program.h"
#include "render/view.h"

namespace searchlight {

/// The mesh of an object on a device.
class VisibleGl {
public:
    /// The object and the context outlive it.
    VisibleGl(gl::Context& context, const Object& object);

    /// As traceVisible() has it, within the rounding of a rasteriser: at the outline of a triangle, 1/256 of a pixel
    /// beside it, its neighbour may be taken. The triangles are found on the device, in a picture for the centres and
    /// one for each of options.edge_samples; positions and normals are computed here, in double.
    VisibleSurface visible(const View& view, const TraceOptions& options, Observer& observer);

private:
    // Triangle + 1 per pixel, seen through the point (x, y) of each.
    std::vector<std::uint32_t> triangles(const View& view, double x, double y);

    gl::Context& context_;
    const Object& object_;
    gl::RasterProgram program_;
    gl::Buffer corners_, vertices_;
};

}  // namespace searchlight
