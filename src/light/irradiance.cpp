#include "light/irradiance.h"

#include <algorithm>
#include <cassert>

#include "base/error.h"
#include "base/parallel.h"
#include "light/environment.h"
#include "light/environment_beams.h"
#include "light/environment_irradiance.h"
#include "light/single_lights.h"
#include "light/stratified.h"

namespace searchlight {

namespace {

void add(Rgbf& sum, const Rgbf& value) { sum = {sum.r + value.r, sum.g + value.g, sum.b + value.b}; }

/// An environment that the object shadows, by what the light samples so far gave.
struct Occluded {
    std::shared_ptr<const Environment> environment;
    StratifiedSequence sequence;
    std::vector<Rgb> sums;  ///< per point, along points.order
    int samples = 0;
};

}  // namespace

struct ProgressiveIrradiance::Impl {
    const LitPoints& points;
    const Object& object;
    const RayScene* rays;
    IrradianceOptions options;
    TransmittedCosine transmitted_cosine;
    std::vector<Rgbf> fixed;        ///< all but occluded environments, in the caller's order
    std::vector<Beam> fixed_beams;  ///< the same, where beams are asked for
    std::vector<Occluded> occluded;
    std::vector<std::vector<Beam>> occluded_beams;  ///< as traced, before appendFitted(); parallel to `occluded`

    Lighting lighting(Observer& observer) const {
        return {points, object, rays, options, transmitted_cosine, observer};
    }

    void addBeam(Beam beam) {
        for (std::size_t i = 0; i < fixed.size(); ++i) add(fixed[i], beam.flux[i]);
        if (options.beams) fixed_beams.push_back(std::move(beam));
    }

    void addLight(const DirectionalLight& light, Observer& observer) {
        addBeam(directionalBeam(lighting(observer), light));
    }
    void addLight(const PointLight& light, Observer& observer) { addBeam(pointBeam(lighting(observer), light)); }

    void addLight(const EnvironmentLight& light, Observer& observer) {
        auto shared = std::make_shared<const Environment>(light);
        const Environment& environment = *shared;
        if (observer.cancelled()) throw interruptedError();
        const bool shadows = light.occlusion && rays;
        std::vector<Beam> beams;
        if (options.beams) beams = traceBeams(environment, shadows, observer);
        if (shadows) {
            occluded.push_back({std::move(shared), StratifiedSequence(options.seed + occluded.size()),
                                std::vector<Rgb>(points.size())});
            occluded_beams.push_back(std::move(beams));
            return;
        }
        const EnvironmentIrradiance by_normal(environment, options.eta, options.threads);
        std::vector<Rgbf> flux(points.size());
        lighting(observer).forEachBlock([&](std::size_t first, LitBlock& block) {
            for (std::size_t i = first; i < first + block.size(); ++i)
                flux[points.order[i]] = by_normal(points.normals[i]);
        });
        for (std::size_t i = 0; i < fixed.size(); ++i) add(fixed[i], flux[i]);
        appendFitted(std::move(beams), points, flux, fixed_beams);
    }

    std::vector<Beam> traceBeams(const Environment& environment, bool shadows, Observer& observer) const {
        std::vector<Beam> beams;
        Lighting unshadowed = lighting(observer);
        if (!shadows) unshadowed.rays = nullptr;
        for (const EnvironmentBeam& part : environmentBeams(environment, options.beam_count, options.seed)) {
            Beam beam{{toFloat(part.wi)}, std::vector<Rgbf>(points.size())};
            unshadowed.forEachBlock([&](std::size_t first, LitBlock& block) {
                block.forEachLit(toFloat(part.wi), [&](std::uint32_t i, float cosine) {
                    beam.flux[points.order[first + i]] = toFloat(transmitted_cosine(cosine) * part.irradiance);
                });
            });
            beams.push_back(std::move(beam));
        }
        return beams;
    }

    std::vector<Rgb> moreSums(const Occluded& light, int count, Observer& observer) const {
        std::vector<std::pair<Vec3f, Rgbf>> directions;
        for (int s = light.samples; s < light.samples + count; ++s) {
            const auto [u, v] = light.sequence(static_cast<std::uint32_t>(s));
            const EnvironmentSample chosen = light.environment->sample(u, v);
            if (chosen.pdf > 0) directions.push_back({toFloat(chosen.wi), toFloat((1 / chosen.pdf) * chosen.radiance)});
        }
        std::vector<Rgb> sums = light.sums;
        lighting(observer).forEachBlock([&](std::size_t first, LitBlock& block) {
            Rgb* const block_sums = &sums[first];
            for (const auto& [wi, weight] : directions)
                block.forEachLit(wi, [&](std::uint32_t i, float cosine) {
                    const double crossed = transmitted_cosine(cosine);
                    Rgb& sum = block_sums[i];
                    sum = {sum.r + crossed * weight.r, sum.g + crossed * weight.g, sum.b + crossed * weight.b};
                });
        });
        return sums;
    }
};

ProgressiveIrradiance::ProgressiveIrradiance(const LitPoints& points, const Scene& scene, const Object& object,
                                             const RayScene* rays, const IrradianceOptions& options, Observer& observer)
    : impl_(new Impl{points, object, rays, options, TransmittedCosine(options.eta)}) {
    assert(options.beam_count >= 1 && options.light_samples >= 1 && options.disc_samples >= 1);
    impl_->fixed.resize(points.size());
    for (const Light& light : scene.lights)
        std::visit([&](const auto& kind) { impl_->addLight(kind, observer); }, light);
}

ProgressiveIrradiance::~ProgressiveIrradiance() = default;
ProgressiveIrradiance::ProgressiveIrradiance(ProgressiveIrradiance&&) noexcept = default;
ProgressiveIrradiance& ProgressiveIrradiance::operator=(ProgressiveIrradiance&&) noexcept = default;

int ProgressiveIrradiance::samples() const { return impl_->occluded.empty() ? 0 : impl_->occluded.front().samples; }

bool ProgressiveIrradiance::complete() const {
    return impl_->occluded.empty() || samples() >= impl_->options.light_samples;
}

void ProgressiveIrradiance::step(int count, Observer& observer) {
    std::vector<std::vector<Rgb>> sums;
    for (const Occluded& light : impl_->occluded) sums.push_back(impl_->moreSums(light, count, observer));
    for (std::size_t k = 0; k < sums.size(); ++k) {
        impl_->occluded[k].sums = std::move(sums[k]);
        impl_->occluded[k].samples += count;
    }
    observer.progress("irradiance", static_cast<std::uint64_t>(samples()),
                      static_cast<std::uint64_t>(impl_->options.light_samples), "light samples");
}

Irradiance ProgressiveIrradiance::result() const {
    Irradiance result{impl_->fixed, impl_->fixed_beams};
    for (std::size_t k = 0; k < impl_->occluded.size(); ++k) {
        const Occluded& light = impl_->occluded[k];
        std::vector<Rgbf> flux(impl_->points.size());
        for (std::size_t i = 0; i < flux.size(); ++i)
            if (light.samples > 0) flux[impl_->points.order[i]] = toFloat((1.0 / light.samples) * light.sums[i]);
        for (std::size_t i = 0; i < flux.size(); ++i) add(result.transmitted[i], flux[i]);
        appendFitted(impl_->occluded_beams[k], impl_->points, flux, result.beams);
    }
    return result;
}

Irradiance computeIrradiance(const LitPoints& points, const Scene& scene, const Object& object, const RayScene* rays,
                             const IrradianceOptions& options, Observer& observer) {
    ProgressiveIrradiance irradiance(points, scene, object, rays, options, observer);
    // Steps of a second or less, so that a wish to stop is heard.
    while (!irradiance.complete())
        irradiance.step(std::min(256, options.light_samples - irradiance.samples()), observer);
    return irradiance.result();
}

Irradiance computeIrradiance(const SurfacePoints& points, const Scene& scene, const Object& object,
                             const RayScene* rays, const IrradianceOptions& options, Observer& observer) {
    return computeIrradiance(prepareLitPoints(points, object, rays, options.normals, options.threads, observer), scene,
                             object, rays, options, observer);
}

}  // namespace searchlight
