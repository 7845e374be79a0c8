// A triangle mesh, as plain data.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/vec.h"

namespace searchlight {

/// Counter-clockwise seen from outside. A vertex that has two normals or two texture coordinates stands twice.
struct Mesh {
    std::vector<Vec3f> positions;
    std::vector<Vec3f> normals;  ///< one per vertex, unit length, or empty
    std::vector<Vec2f> uvs;      ///< one per vertex, v upwards, or empty
    std::vector<std::array<std::uint32_t, 3>> triangles;
};

}  // namespace searchlight
