#include "geometry/surface_walk.h"

#include <algorithm>

#include "geometry/edges.h"
#include "geometry/vertex_normals.h"

namespace searchlight {

SurfaceWalk::SurfaceWalk(const Mesh& mesh)
    : mesh_(mesh), neighbours_(triangleNeighbours(mesh)), normals_(mesh.triangles.size()) {
    for (std::size_t t = 0; t < normals_.size(); ++t) {
        const Vec3 normal = triangleNormal(mesh, t);
        const double size = length(normal);
        if (size > 0) normals_[t] = toFloat((1 / size) * normal);
    }
}

Vec3 SurfaceWalk::position(const SurfacePlace& place) const {
    const auto& [a, b, c] = mesh_.triangles[place.triangle];
    return (1 - place.u - place.v) * toDouble(mesh_.positions[a]) + place.u * toDouble(mesh_.positions[b]) +
           place.v * toDouble(mesh_.positions[c]);
}

Vec3 SurfaceWalk::shadingNormal(const SurfacePlace& place) const {
    const auto& [a, b, c] = mesh_.triangles[place.triangle];
    if (!mesh_.normals.empty()) {
        const Vec3 sum = (1 - place.u - place.v) * toDouble(mesh_.normals[a]) + place.u * toDouble(mesh_.normals[b]) +
                         place.v * toDouble(mesh_.normals[c]);
        const double size = length(sum);
        if (size > 1e-6) return (1 / size) * sum;
    }
    return normal(place.triangle);
}

SurfacePlace SurfaceWalk::move(SurfacePlace place, Vec3 step) const {
    // A step crosses few triangles; one that crosses this many turns around a vertex.
    constexpr int most_crossings = 64;
    double b[3] = {1 - place.u - place.v, place.u, place.v};
    std::uint32_t triangle = place.triangle;
    for (int crossing = 0; crossing < most_crossings; ++crossing) {
        const auto& corners = mesh_.triangles[triangle];
        Vec3 p[3];
        for (int k = 0; k < 3; ++k) p[k] = toDouble(mesh_.positions[corners[k]]);
        const Vec3 e1 = p[1] - p[0], e2 = p[2] - p[0];
        const double e11 = dot(e1, e1), e12 = dot(e1, e2), e22 = dot(e2, e2), det = e11 * e22 - e12 * e12;
        // 1e-12: a sliver whose sine is 1e-6, in which floats of the positions know no direction.
        if (!(det > 1e-12 * e11 * e22)) break;
        const double s1 = dot(step, e1), s2 = dot(step, e2);
        double change[3];
        change[1] = (e22 * s1 - e12 * s2) / det;
        change[2] = (e11 * s2 - e12 * s1) / det;
        change[0] = -change[1] - change[2];
        double reach = 1;
        int leaves = -1;  // across the side opposite to this corner
        for (int k = 0; k < 3; ++k)
            if (change[k] < 0 && b[k] + reach * change[k] < 0) reach = std::max(0.0, -b[k] / change[k]), leaves = k;
        for (int k = 0; k < 3; ++k) b[k] = std::max(0.0, b[k] + reach * change[k]);
        if (leaves < 0) break;
        b[leaves] = 0;
        const int from = (leaves + 1) % 3, to = (leaves + 2) % 3;  // side `from` runs between these corners
        const Vec3 edge = normalize(p[to] - p[from]);
        const Vec3 rest = (1 - reach) * (step - dot(step, normal(triangle)) * normal(triangle));
        const std::uint32_t next = neighbours_[triangle][from];
        if (next == no_triangle || !(length(normal(next)) > 0)) {
            step = dot(rest, edge) * edge;
            continue;
        }
        // Outward across the side here, inward there.
        const double across = std::max(0.0, dot(rest, cross(edge, normal(triangle))));
        step = dot(rest, edge) * edge + across * cross(edge, normal(next));
        // The same side seen from there runs the other way.
        int side = 0;
        while (side < 3 && !(neighbours_[next][side] == triangle &&
                             mesh_.positions[mesh_.triangles[next][side]] == mesh_.positions[corners[to]]))
            ++side;
        if (side == 3) break;
        const double at_from = b[from], at_to = b[to];
        b[side] = at_to;
        b[(side + 1) % 3] = at_from;
        b[(side + 2) % 3] = 0;
        triangle = next;
    }
    const double sum = b[0] + b[1] + b[2];
    return {triangle, b[1] / sum, b[2] / sum};
}

}  // namespace searchlight
