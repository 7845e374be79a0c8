// Evenly spread points on a mesh: the samples of irradiance that hierarchical rendering sums over.
#pragma once

#include <cstdint>

#include "base/observer.h"
#include "scene/mesh.h"
#include "scene/point_cloud.h"

namespace searchlight {

enum class PointMethod {
    turk,  ///< random points that push each other apart on the surface [Turk1992], as the thesis has it
    fast,  ///< equal quality in a fraction of the time
};

struct PointOptions {
    std::size_t count = 200'000;
    PointMethod method = PointMethod::fast;
    std::uint64_t seed = 1;
    int threads = 0;  ///< 0: all
};

/// `count` blue-noise points with normals (interpolated where the mesh has them, else of the triangle) and areas, which
/// sum to the mesh's. The result does not depend on threads. Throws an input Error for a mesh without area,
/// interruptedError() when cancelled.
PointCloud samplePoints(const Mesh& mesh, const PointOptions& options, Observer& observer);

}  // namespace searchlight
