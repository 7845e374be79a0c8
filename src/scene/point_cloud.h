// Points on a surface, as plain data.
#pragma once

#include <vector>

#include "base/vec.h"

namespace searchlight {

/// Lists are empty or hold one value per point.
struct PointCloud {
    std::vector<Vec3f> positions;
    std::vector<Vec3f> normals;  ///< unit length, outward; a zero normal is one that nobody knows
    std::vector<float> areas;    ///< of the surface that the point stands for, in the square of the positions' unit
};

}  // namespace searchlight
