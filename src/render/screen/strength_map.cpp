#include "render/screen/strength_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
#include "io/image_file.h"

namespace searchlight {

namespace {

constexpr std::size_t block = 64;
constexpr float most_strength = 1000;  // more is a mistake, and lengths stay finite

// Rows from the top, v upwards.
float bilinear(const Image& picture, double u, double v) {
    const double x = (u - std::floor(u)) * picture.width - 0.5, y = (1 - (v - std::floor(v))) * picture.height - 0.5;
    const auto texel = [&](double column, double row) {
        const int w = picture.width, h = picture.height;
        const Rgba& p = picture.at((static_cast<int>(column) + w) % w, (static_cast<int>(row) + h) % h);
        return luminance({p.r, p.g, p.b});
    };
    const double left = std::floor(x), top = std::floor(y), fx = x - left, fy = y - top;
    return static_cast<float>((1 - fy) * ((1 - fx) * texel(left, top) + fx * texel(left + 1, top)) +
                              fy * ((1 - fx) * texel(left, top + 1) + fx * texel(left + 1, top + 1)));
}

}  // namespace

std::vector<float> strengthAt(const std::string& path, const VisibleSurface& visible, const Object& object,
                              const RayScene& rays, int threads) {
    if (object.mesh.uvs.empty())
        throw inputError(fmt::format("{} has no texture coordinates, which a strength map needs", object.name),
                         "an .obj with vt lines, a .ply with u and v or a .gltf has them");
    const Image picture = readImage(path).image;
    for (const Rgba& p : picture.pixels)
        for (const float value : {p.r, p.g, p.b})
            if (!(value >= 0 && value <= most_strength))
                throw inputError(fmt::format("{}: a strength is {}, expected 0 to {}", path, value, most_strength),
                                 "lengths are multiplied by the picture's luminance");
    const std::size_t count = visible.positions.size();
    std::vector<float> strength(count, 1.0f);
    parallelFor((count + block - 1) / block, threads, [&](std::size_t part) {
        const std::size_t begin = part * block, size = std::min(block, count - begin);
        std::array<Ray, block> wanted;
        std::array<RayHit, block> hits;
        for (std::size_t k = 0; k < size; ++k) {
            const Vec3 way = toDouble(visible.positions[begin + k]) - visible.eye;
            wanted[k] = {toFloat(visible.eye), toFloat(way)};
        }
        rays.intersect(std::span(wanted).first(size), std::span(hits).first(size), true);
        for (std::size_t k = 0; k < size; ++k) {
            const RayHit& hit = hits[k];
            if (!std::isfinite(hit.t)) continue;  // slipped past an outline by rounding
            const auto& [a, b, c] = object.mesh.triangles[hit.triangle];
            const auto between = [&](float Vec2f::*axis) {
                return static_cast<double>((1 - hit.u - hit.v) * (object.mesh.uvs[a].*axis) +
                                           hit.u * (object.mesh.uvs[b].*axis) + hit.v * (object.mesh.uvs[c].*axis));
            };
            strength[begin + k] = bilinear(picture, between(&Vec2f::x), between(&Vec2f::y));
        }
    });
    return strength;
}

}  // namespace searchlight
