#include "geometry/atlas/surface_graph.h"

#include "geometry/weld.h"

namespace searchlight {

SurfaceGraph::SurfaceGraph(const Mesh& mesh) : neighbours(triangleNeighbours(mesh)) {
    const Weld weld = weldPositions(mesh.positions);
    positions.resize(weld.count);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) positions[weld.of[i]] = toDouble(mesh.positions[i]);
    for (const auto& [a, b, c] : mesh.triangles) {
        triangles.push_back({weld.of[a], weld.of[b], weld.of[c]});
        const Vec3 p = positions[weld.of[a]], q = positions[weld.of[b]], r = positions[weld.of[c]];
        const Vec3 normal = cross(q - p, r - p);
        const double size = length(normal);
        centres.push_back((1.0 / 3) * (p + q + r));
        normals.push_back(size > 0 ? (1 / size) * normal : Vec3{});
        areas.push_back(size / 2);
    }
}

}  // namespace searchlight
