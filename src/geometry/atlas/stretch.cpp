#include "geometry/atlas/stretch.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace searchlight {

Stretch stretchOf(std::span<const MappedTriangle> triangles) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    double on_surface = 0, in_plane = 0;
    for (const auto& [p, q] : triangles) {
        on_surface += length(cross(p[1] - p[0], p[2] - p[0]));
        in_plane += cross(q[1] - q[0], q[2] - q[0]);
    }
    if (!(on_surface > 0)) return {};
    const double scale = in_plane / on_surface;  // areas in the plane per area on the surface
    double squares = 0, logs = 0, worst = 0, largest = 0;
    for (const auto& [p, q] : triangles) {
        const Vec3 along = p[1] - p[0], across = p[2] - p[0];
        const double area = length(cross(along, across));
        if (!(area > 0)) continue;
        const Vec2 u = q[1] - q[0], v = q[2] - q[0];
        const double flat = cross(u, v);
        if (!(flat > 0)) return {infinity, infinity, infinity, infinity};
        // Derivatives of the place on the surface by the two coordinates of the plane.
        const Vec3 by_x = (1 / flat) * (v.y * along - u.y * across), by_y = (1 / flat) * (u.x * across - v.x * along);
        const double a = dot(by_x, by_x), b = dot(by_x, by_y), c = dot(by_y, by_y);
        squares += area * 0.5 * (a + c) * scale;
        const double gamma = 0.5 * (a + c + std::sqrt((a - c) * (a - c) + 4 * b * b)) * scale;
        worst = std::max(worst, gamma);
        const double ratio = area / flat * scale;
        logs += area * std::log(ratio) * std::log(ratio);
        largest = std::max(largest, ratio);
    }
    return {std::sqrt(squares / on_surface), std::sqrt(worst), std::sqrt(logs / on_surface), largest};
}

}  // namespace searchlight
