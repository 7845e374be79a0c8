#include <algorithm>
#include <cmath>

#include "geometry/atlas/atlas.h"
#include "geometry/edges.h"

namespace searchlight {

namespace {

// Hues by the golden angle: neighbours in number are far apart in colour.
Rgba colourOf(std::uint32_t chart, double brightness) {
    const double hue = 2.399963229728653 * chart;
    const auto channel = [&](double turn) {
        return static_cast<float>(brightness * (0.45 + 0.3 * std::cos(hue + turn)));
    };
    return {channel(0), channel(2.0944), channel(4.1888), 1};
}

}  // namespace

Image atlasPicture(const Mesh& mesh, const Atlas& atlas, int scale) {
    const int size = atlas.resolution * scale;
    Image image(size, size);
    double on_surface = 0, in_plane = 0;
    std::vector<double> areas, flats;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto& [a, b, c] = mesh.triangles[t];
        const Vec3 origin = toDouble(mesh.positions[a]);
        areas.push_back(length(cross(toDouble(mesh.positions[b]) - origin, toDouble(mesh.positions[c]) - origin)));
        const FlatTriangle& flat = atlas.triangles[t];
        flats.push_back(cross(flat[1] - flat[0], flat[2] - flat[0]));
        if (atlas.charts[t] != no_triangle) on_surface += areas.back(), in_plane += flats.back();
    }
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        if (atlas.charts[t] == no_triangle) continue;
        FlatTriangle flat = atlas.triangles[t];
        for (Vec2& p : flat) p = static_cast<double>(scale) * p;
        const auto [x0, x1] = std::minmax({flat[0].x, flat[1].x, flat[2].x});
        const auto [y0, y1] = std::minmax({flat[0].y, flat[1].y, flat[2].y});
        const double surface_per_texel = areas[t] / flats[t] * in_plane / on_surface;
        const Rgba colour = colourOf(atlas.charts[t], std::clamp(1 / surface_per_texel, 0.1, 1.6));
        for (int y = std::max(0, static_cast<int>(y0)); y <= std::min(size - 1, static_cast<int>(y1)); ++y)
            for (int x = std::max(0, static_cast<int>(x0)); x <= std::min(size - 1, static_cast<int>(x1)); ++x) {
                const Vec2 p{x + 0.5, y + 0.5};
                bool inside = true;
                for (std::size_t k = 0; k < 3; ++k) inside &= cross(flat[(k + 1) % 3] - flat[k], p - flat[k]) >= 0;
                if (inside) image.at(x, size - 1 - y) = colour;
            }
    }
    return image;
}

}  // namespace searchlight
