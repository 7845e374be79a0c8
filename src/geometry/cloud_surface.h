// A surface through a point cloud, so that rays have something to hit.
#pragma once

#include "scene/mesh.h"
#include "scene/point_cloud.h"

namespace searchlight {

/// The zero set of the mean of the points' planes, weighted by nearness [Kolluri2005], cut into triangles about 1.5
/// spacings long. Closed where points lie all around; it ends where they do. Seconds for 500,000 points. Requires a
/// normal per point and positive areas; empty when there are too few points to see a surface.
Mesh surfaceThrough(const PointCloud& cloud, int threads = 0);

}  // namespace searchlight
