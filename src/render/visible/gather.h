// From hits to the list of visible samples: positions and normals, edges and what they divide.
#pragma once

#include <memory>

#include "render/view.h"
#include "render/visible/tile_hits.h"

namespace searchlight {

/// Keeps its memory from one picture to the next.
class SurfaceGatherer {
public:
    SurfaceGatherer();
    ~SurfaceGatherer();

    /// Fills `visible`, by one hit per pixel and, where options ask for it, those of the edge pattern in pixels whose
    /// neighbour lies on another patch of the surface. Throws interruptedError() when cancelled.
    void gather(const View& view, const Mesh& mesh, const HitSource& source, const TraceOptions& options,
                Observer& observer, VisibleSurface& visible);

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace searchlight
