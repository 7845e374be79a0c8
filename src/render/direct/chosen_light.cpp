#include "render/direct/chosen_light.h"

#include "light/stratified.h"

namespace searchlight {

namespace {

void add(Irradiance&& more, Irradiance& to) {
    for (std::size_t i = 0; i < to.transmitted.size(); ++i) {
        Rgbf& sum = to.transmitted[i];
        const Rgbf& value = more.transmitted[i];
        sum = {sum.r + value.r, sum.g + value.g, sum.b + value.b};
    }
    for (Beam& beam : more.beams) to.beams.push_back(std::move(beam));
}

}  // namespace

ChosenLight::ChosenLight(const RenderInput& input)
    : object_(input.object), rays_(input.rays), options_(input.light), still_(*input.scene) {
    still_.lights.clear();
    for (const Light& light : input.scene->lights) {
        const auto* surroundings = std::get_if<EnvironmentLight>(&light);
        if (!surroundings) {
            still_.lights.push_back(light);
        } else if (surroundings->occlusion || options_.beams) {
            drawn_.push_back({Environment(*surroundings), surroundings->occlusion});
        } else {
            by_normal_.emplace_back(Environment(*surroundings), options_.eta, options_.threads);
        }
    }
}

Irradiance ChosenLight::at(const SurfacePoints& points, int directions, std::uint64_t seed, Observer& observer) const {
    Scene shadowed = still_, open = still_;
    open.lights.clear();
    for (std::size_t k = 0; k < drawn_.size(); ++k) {
        const StratifiedSequence sequence(seed + k);
        for (int s = 0; s < directions; ++s) {
            const auto [u, v] = sequence(static_cast<std::uint32_t>(s));
            const EnvironmentSample sample = drawn_[k].environment.sample(u, v);
            if (!(sample.pdf > 0)) continue;
            (drawn_[k].shadows ? shadowed : open)
                .lights.push_back(DirectionalLight{.direction = sample.wi,
                                                   .irradiance = (1 / (sample.pdf * directions)) * sample.radiance});
        }
    }
    Irradiance light = computeIrradiance(points, shadowed, *object_, rays_, options_, observer);
    if (!open.lights.empty()) add(computeIrradiance(points, open, *object_, nullptr, options_, observer), light);
    for (const EnvironmentIrradiance& by_normal : by_normal_)
        for (std::size_t i = 0; i < points.normals.size(); ++i) {
            const Rgbf value = by_normal(points.normals[i]);
            Rgbf& sum = light.transmitted[i];
            sum = {sum.r + value.r, sum.g + value.g, sum.b + value.b};
        }
    return light;
}

}  // namespace searchlight
