#include "light/single_lights.h"

#include <algorithm>
#include <array>
#include <optional>

#include "base/error.h"
#include "base/parallel.h"
#include "light/disc.h"
#include "light/light_filter.h"
#include "light/stratified.h"

namespace searchlight {

namespace {

// The light of a disc on the points of a block: the sum of T12 cos over what each of them sees of it. The first quarter
// of the directions asks for shadow at every point, the rest only where these disagreed: at the edges of shadows.
void sumDisc(LitBlock& block, const DiscSamples& disc, const TransmittedCosine& transmitted_cosine,
             std::span<float> sums) {
    const std::size_t pilot = std::max<std::size_t>(1, disc.directions.size() / 4);
    std::array<ViewOfLight, LitBlock::capacity> views{};
    std::array<bool, LitBlock::capacity> open{}, blocked{};
    for (std::size_t s = 0; s < disc.directions.size(); ++s) {
        if (s == pilot)
            for (std::size_t i = 0; i < block.size(); ++i)
                views[i] = open[i] == blocked[i] ? ViewOfLight::unknown
                           : open[i]             ? ViewOfLight::open
                                                 : ViewOfLight::blocked;
        block.forEachFacing(disc.directions[s], views, [&](std::uint32_t i, float cosine, bool visible) {
            (visible ? open : blocked)[i] = true;
            if (visible) sums[i] += transmitted_cosine(cosine);
        });
    }
}

}  // namespace

void Lighting::forEachBlock(const std::function<void(std::size_t, LitBlock&)>& body) const {
    const std::size_t blocks = (points.size() + LitBlock::capacity - 1) / LitBlock::capacity;
    parallelFor(blocks, options.threads, [&](std::size_t b) {
        if (observer.cancelled()) throw interruptedError();
        LitBlock block(points, b * LitBlock::capacity, rays);
        body(b * LitBlock::capacity, block);
    });
}

double boundingRadius(const Object& object) { return length(object.half_extent); }

DiscSamples discSamples(const DirectionalLight& light, int count, std::uint64_t seed) {
    const Disc disc(light);
    if (light.angle_deg <= 0) return {{toFloat(disc.sample(0, 0))}, 1};
    const StratifiedSequence sequence(seed);
    DiscSamples samples{{}, disc.weight() / count};
    for (int i = 0; i < count; ++i) {
        const auto [u, v] = sequence(static_cast<std::uint32_t>(i));
        samples.directions.push_back(toFloat(disc.sample(u, v)));
    }
    return samples;
}

Beam directionalBeam(const Lighting& lighting, const DirectionalLight& light) {
    const LitPoints& points = lighting.points;
    const DiscSamples disc = discSamples(light, lighting.options.disc_samples, lighting.options.seed);
    std::optional<LightFilter> filter;
    if (!light.filter.empty()) filter.emplace(light.filter, light.direction, boundingRadius(lighting.object));
    Beam beam{{toFloat(normalize(light.direction))}, std::vector<Rgbf>(points.size())};
    lighting.forEachBlock([&](std::size_t first, LitBlock& block) {
        std::array<float, LitBlock::capacity> sums{};
        sumDisc(block, disc, lighting.transmitted_cosine, sums);
        for (std::size_t i = 0; i < block.size(); ++i) {
            if (sums[i] == 0) continue;
            Rgb flux = (disc.weight * sums[i]) * light.irradiance;
            if (filter) flux = flux * (*filter)(toDouble(points.positions[first + i]), points.spacing_mm);
            beam.flux[points.order[first + i]] = toFloat(flux);
        }
    });
    return beam;
}

Beam pointBeam(const Lighting& lighting, const PointLight& light) {
    const LitPoints& points = lighting.points;
    const double unit_mm = lighting.object.longest_mm;
    const Vec3 place = unit_mm * light.position;
    Beam beam{std::vector<Vec3f>(points.size()), std::vector<Rgbf>(points.size())};
    lighting.forEachBlock([&](std::size_t first, LitBlock& block) {
        std::vector<Ray> rays;
        std::vector<std::size_t> facing;
        for (std::size_t i = first; i < first + block.size(); ++i) {
            const Vec3 to_light = place - toDouble(points.positions[i]);
            const double distance = length(to_light);
            if (distance == 0) continue;  // the light lies on the point: no direction, no side
            const Vec3 wi = (1 / distance) * to_light;
            beam.wi[points.order[i]] = toFloat(wi);
            const double weight = lighting.transmitted_cosine(static_cast<float>(dot(wi, toDouble(points.normals[i]))));
            if (weight == 0) continue;
            const double inverse_square = (unit_mm / distance) * (unit_mm / distance);
            beam.flux[points.order[i]] = toFloat((weight * inverse_square) * light.intensity);
            facing.push_back(i);
            rays.push_back({points.origins[i], toFloat(place - toDouble(points.origins[i])), 0, 1});
        }
        if (!lighting.rays) return;
        std::vector<std::uint8_t> blocked(rays.size());
        lighting.rays->occluded(rays, blocked, true);
        for (std::size_t k = 0; k < facing.size(); ++k)
            if (blocked[k]) beam.flux[points.order[facing[k]]] = {};
    });
    return beam;
}

}  // namespace searchlight
