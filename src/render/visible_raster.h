// What the camera sees, by drawing triangles on the CPU.
#pragma once

#include <memory>

#include "render/view.h"

namespace searchlight {

/// Keeps its memory from one picture to the next.
class VisibleRaster {
public:
    VisibleRaster();
    ~VisibleRaster();

    /// Fills `visible` as traceVisible() does. Both find the same triangles but where a ray meets an edge within
    /// rounding (1e-6 of a pixel, against some 1e-4 of rays that are traced).
    void find(const View& view, const Object& object, const TraceOptions& options, Observer& observer,
              VisibleSurface& visible);

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace searchlight
