#include "render/light_picture.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/parallel.h"
#include "geometry/point_grid.h"

namespace searchlight {

namespace {

// Samples that one thread takes at a time: neighbours in space, which read the same cells.
constexpr std::size_t block = 1024;

double spacing(const PointCloud& points) {
    double area = 0;
    for (const float each : points.areas) area += each;
    return std::sqrt(area / static_cast<double>(std::max<std::size_t>(points.positions.size(), 1)));
}

struct Nearest {
    std::uint32_t index = 0;
    float distance_mm = std::numeric_limits<float>::infinity();
};

// shade(nearest point) gives the radiance of a sample.
template <class Shade>
Image paint(const RenderStages& stages, const Shade& shade) {
    const VisibleSurface& visible = *stages.visible;
    const PointCloud& points = *stages.points;
    Image picture(visible.width, visible.height);
    if (points.positions.empty() || visible.positions.empty()) return picture;
    // Blue noise leaves no hole wider than some 1.6 spacings.
    const auto reach = static_cast<float>(2 * spacing(points));
    const PointGrid grid(points.positions, std::max(reach, 1e-6f));
    std::vector<Rgbf> radiance(visible.positions.size());
    const std::size_t blocks = (visible.positions.size() + block - 1) / block;
    parallelFor(blocks, 0, [&](std::size_t b) {
        std::vector<PointGrid::Entry> found;
        for (std::size_t i = b * block; i < std::min((b + 1) * block, radiance.size()); ++i) {
            const Vec3f at = visible.positions[i];
            found.clear();
            grid.gather({at.x - reach, at.y - reach, at.z - reach}, {at.x + reach, at.y + reach, at.z + reach}, found);
            Nearest nearest;
            for (const PointGrid::Entry& entry : found) {
                const float dx = entry.position.x - at.x, dy = entry.position.y - at.y, dz = entry.position.z - at.z;
                const float distance = std::sqrt(dx * dx + dy * dy + dz * dz);
                if (distance < nearest.distance_mm) nearest = {entry.index, distance};
            }
            if (std::isfinite(nearest.distance_mm)) radiance[i] = shade(nearest);
        }
    });
    for (std::size_t i = 0; i < radiance.size(); ++i) {
        Rgba& pixel = picture.pixels[visible.pixels[i]];
        const float coverage = visible.coverage[i];
        pixel.r += coverage * radiance[i].r;
        pixel.g += coverage * radiance[i].g;
        pixel.b += coverage * radiance[i].b;
        pixel.a += coverage;
    }
    return picture;
}

Rgbf lightAt(const RenderStages& stages, std::uint32_t index) {
    constexpr auto per_pi = static_cast<float>(1 / std::numbers::pi);
    const Rgbf flux = stages.irradiance->transmitted[index];
    return {per_pi * flux.r, per_pi * flux.g, per_pi * flux.b};
}

}  // namespace

Image irradiancePicture(const RenderStages& stages) {
    return paint(stages, [&](const Nearest& nearest) { return lightAt(stages, nearest.index); });
}

Image pointsPicture(const RenderStages& stages) {
    // Wide enough to be seen, narrow enough to be told apart.
    const auto radius = static_cast<float>(0.3 * spacing(*stages.points));
    return paint(stages, [&](const Nearest& nearest) -> Rgbf {
        if (nearest.distance_mm > radius) return {0.004f, 0.004f, 0.005f};
        const Rgbf light = lightAt(stages, nearest.index);
        constexpr float least = 0.02f;  // in shadow points are there, too
        return {std::max(light.r, least), std::max(light.g, least), std::max(light.b, least)};
    });
}

}  // namespace searchlight
