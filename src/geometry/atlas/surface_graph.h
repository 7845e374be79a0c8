// A mesh as charts see it: triangles by their welded corners, and who lies next to whom.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geometry/edges.h"
#include "scene/mesh.h"

namespace searchlight {

/// One entry per triangle of the mesh. Cuts of uvs and normals are closed: corners are numbers of welded positions.
struct SurfaceGraph {
    std::vector<Vec3> positions;  ///< of the welded corners
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::vector<std::array<std::uint32_t, 3>> neighbours;  ///< across side k; no_triangle at an edge of the surface
    std::vector<Vec3> centres, normals;                    ///< normals unit; zero for a triangle without area
    std::vector<double> areas;                             ///< 0 where two corners are one, too

    explicit SurfaceGraph(const Mesh& mesh);
};

}  // namespace searchlight
