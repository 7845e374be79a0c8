#include "render/shade.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <functional>
#include <numbers>

#include "base/parallel.h"
#include "model/physics.h"

namespace searchlight {

namespace {

// Interpolated normals turn away from the eye where triangles do not: on creases and where a mesh folds back on itself
// its vertices' normals are means of sides that have nothing to do with each other, and T21 of them draws black lines
// and specks. So the cosine is at least so much of the triangle's: half of it where the normals agree within 25
// degrees, as they do on smooth surfaces up to their outlines, all of it from 45 degrees on and up to 0.1.
double trust(double agreement) { return std::clamp(1 - 2.5 * (agreement - 0.7), 0.5, 1.0); }

}  // namespace

std::vector<Rgbf> exitRadiance(const VisibleSurface& visible, std::span<const Rgbf> exitance, double eta, int threads) {
    assert(exitance.size() == visible.positions.size());
    using Fresnel = Physics<double>;
    const double normalizer = std::numbers::pi * (1 - 2 * Fresnel::fresnelMoment(1, 1 / eta));
    std::vector<Rgbf> radiance(exitance.size());
    constexpr std::size_t chunk = 4096;
    parallelFor((exitance.size() + chunk - 1) / chunk, threads, [&](std::size_t part) {
        for (std::size_t i = part * chunk; i < std::min(exitance.size(), (part + 1) * chunk); ++i) {
            const Vec3 wo = normalize(visible.eye - toDouble(visible.positions[i]));
            const Vec3 normal = toDouble(visible.normals[i]), geometric = toDouble(visible.geometric_normals[i]);
            const double seen = dot(wo, geometric);
            const double least = std::max(trust(dot(normal, geometric)) * seen, std::min(seen, 0.1));
            const double cosine = std::clamp(dot(wo, normal), std::clamp(least, 0.0, 1.0), 1.0);
            const double transmitted = 1 - Fresnel::fresnelReflectance(cosine, 1 / eta);
            radiance[i] = toFloat((transmitted / normalizer) * toDouble(exitance[i]));
        }
    });
    return radiance;
}

double displayExposure(const VisibleSurface& visible, std::span<const Rgbf> radiance) {
    constexpr double brighter = 0.02, white = 0.8;
    // The brightest channel, so that a colour keeps its hue.
    std::vector<std::pair<float, float>> values;  // and coverage
    double total = 0;
    for (std::size_t i = 0; i < radiance.size(); ++i) {
        values.emplace_back(std::max({radiance[i].r, radiance[i].g, radiance[i].b}), visible.coverage[i]);
        total += visible.coverage[i];
    }
    std::ranges::sort(values, std::greater{});
    double seen = 0;
    for (const auto& [value, coverage] : values) {
        seen += coverage;
        if (seen >= brighter * total) return value > 0 ? std::log2(white / value) : 0;
    }
    return 0;
}

Image composite(const VisibleSurface& visible, std::span<const Rgbf> radiance, std::span<const Rgbf> coat,
                const Image& background) {
    assert(radiance.size() == visible.pixels.size() && (coat.empty() || coat.size() == radiance.size()));
    Image object(visible.width, visible.height);
    for (std::size_t i = 0; i < radiance.size(); ++i) {
        Rgba& pixel = object.pixels[visible.pixels[i]];
        const float share = visible.coverage[i];
        const Rgbf on_top = coat.empty() ? Rgbf{} : coat[i];
        pixel.r += share * (std::max(0.0f, radiance[i].r) + on_top.r);
        pixel.g += share * (std::max(0.0f, radiance[i].g) + on_top.g);
        pixel.b += share * (std::max(0.0f, radiance[i].b) + on_top.b);
        pixel.a += share;
    }
    for (std::size_t i = 0; i < object.pixels.size(); ++i) {
        Rgba& pixel = object.pixels[i];
        const Rgba& behind = background.pixels[i];
        pixel.a = std::min(pixel.a, 1.0f);
        const float rest = 1 - pixel.a;
        pixel = {pixel.r + rest * behind.r, pixel.g + rest * behind.g, pixel.b + rest * behind.b,
                 pixel.a + rest * behind.a};
    }
    return object;
}

}  // namespace searchlight
