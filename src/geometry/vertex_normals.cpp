#include "geometry/vertex_normals.h"

#include <cmath>

#include "geometry/weld.h"

namespace searchlight {

Vec3 triangleNormal(const Mesh& mesh, std::size_t triangle) {
    const auto& [a, b, c] = mesh.triangles[triangle];
    const Vec3 p = toDouble(mesh.positions[a]);
    return cross(toDouble(mesh.positions[b]) - p, toDouble(mesh.positions[c]) - p);
}

std::vector<Vec3f> vertexNormals(const Mesh& mesh) {
    const Weld weld = weldPositions(mesh.positions);
    std::vector<Vec3> sums(weld.count);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto& corners = mesh.triangles[t];
        const Vec3 normal = triangleNormal(mesh, t);
        const double twice_area = length(normal);
        if (!(twice_area > 0)) continue;
        for (int k = 0; k < 3; ++k) {
            const Vec3 p = toDouble(mesh.positions[corners[k]]);
            const Vec3 to_next = toDouble(mesh.positions[corners[(k + 1) % 3]]) - p;
            const Vec3 to_last = toDouble(mesh.positions[corners[(k + 2) % 3]]) - p;
            const double angle = std::atan2(twice_area, dot(to_next, to_last));
            Vec3& sum = sums[weld.of[corners[k]]];
            sum = sum + (angle / twice_area) * normal;
        }
    }
    std::vector<Vec3f> normals(mesh.positions.size());
    for (std::size_t i = 0; i < normals.size(); ++i) {
        const Vec3 sum = sums[weld.of[i]];
        const double size = length(sum);
        normals[i] = size > 1e-12 ? toFloat((1 / size) * sum) : Vec3f{0, 1, 0};
    }
    return normals;
}

}  // namespace searchlight
