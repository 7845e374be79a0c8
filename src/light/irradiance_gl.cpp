#include "light/irradiance_gl.h"

#include <algorithm>
#include <cassert>
#include <optional>

#include "base/error.h"
#include "base/parallel.h"
#include "gl/context.h"
#include "light/environment.h"
#include "light/environment_beams.h"
#include "light/environment_irradiance.h"
#include "light/light_filter.h"
#include "light/lit_points_gl.h"
#include "light/single_lights.h"
#include "light/stratified.h"

namespace searchlight {

namespace {

void add(Rgbf& sum, const Rgbf& value) { sum = {sum.r + value.r, sum.g + value.g, sum.b + value.b}; }

// An environment that the object shadows, by the sum of what the light samples so far gave.
struct Occluded {
    std::unique_ptr<const Environment> environment;
    StratifiedSequence sequence;
    gl::Buffer sums;
    std::vector<Beam> beams;  // before appendFitted()
    int samples = 0;
};

}  // namespace

struct ProgressiveIrradianceGl::Impl {
    LitPointsGl& device;
    const LitPoints& points;
    IrradianceOptions options;
    Irradiance fixed;  // all but occluded environments
    std::vector<std::unique_ptr<Occluded>> occluded;

    Impl(LitPointsGl& device_, const IrradianceOptions& options_)
        : device(device_), points(device_.points()), options(options_) {
        fixed.transmitted.resize(points.size());
    }

    void addBeam(Beam beam) {
        for (std::size_t i = 0; i < points.size(); ++i) add(fixed.transmitted[i], beam.flux[i]);
        if (options.beams) fixed.beams.push_back(std::move(beam));
    }

    void addLight(const DirectionalLight& light, Observer& observer) {
        const DiscSamples disc = discSamples(light, options.disc_samples, options.seed);
        const gl::Buffer sums = device.sums();
        std::optional<ShadowMapGl> own;
        if (disc.directions.size() == 1) own.emplace(device.context(), LitPointsGl::single_map, false);
        for (const Vec3f& wi : disc.directions) {
            if (observer.cancelled()) throw interruptedError();
            device.addDirection(own ? *own : device.sharedMap(), toDouble(wi), disc.weight * light.irradiance,
                                options.eta, sums);
        }
        Beam beam{{toFloat(normalize(light.direction))}, device.download(sums, 1)};
        if (!light.filter.empty()) {
            const LightFilter filter(light.filter, light.direction, boundingRadius(device.object()));
            parallelFor(points.size(), options.threads, [&](std::size_t i) {
                Rgbf& flux = beam.flux[points.order[i]];
                flux = toFloat(toDouble(flux) * filter(toDouble(points.positions[i]), points.spacing_mm));
            });
        }
        addBeam(std::move(beam));
    }

    void addLight(const PointLight& light, Observer&) {
        const Vec3 place = device.object().longest_mm * light.position;
        const gl::Buffer sums = device.sums();
        device.addPoint(place, light.intensity, options.eta, sums);
        Beam beam{std::vector<Vec3f>(options.beams ? points.size() : 0), device.download(sums, 1)};
        for (std::size_t i = 0; i < beam.wi.size(); ++i) {
            const Vec3 to_light = place - toDouble(points.positions[i]);
            if (length(to_light) > 0) beam.wi[points.order[i]] = toFloat(normalize(to_light));
        }
        addBeam(std::move(beam));
    }

    void addLight(const EnvironmentLight& light, Observer& observer) {
        auto environment = std::make_unique<const Environment>(light);
        if (observer.cancelled()) throw interruptedError();
        const bool shadowed = light.occlusion && device.shadows();
        std::vector<Beam> beams;
        if (options.beams) beams = drawBeams(*environment, shadowed, observer);
        if (shadowed) {
            occluded.emplace_back(new Occluded{std::move(environment),
                                               StratifiedSequence(options.seed + occluded.size()), device.sums(),
                                               std::move(beams)});
            return;
        }
        const EnvironmentIrradiance by_normal(*environment, options.eta, options.threads);
        std::vector<Rgbf> flux(points.size());
        parallelFor(points.size(), options.threads,
                    [&](std::size_t i) { flux[points.order[i]] = by_normal(points.normals[i]); });
        for (std::size_t i = 0; i < flux.size(); ++i) add(fixed.transmitted[i], flux[i]);
        appendFitted(std::move(beams), points, flux, fixed.beams);
    }

    std::vector<Beam> drawBeams(const Environment& environment, bool shadowed, Observer& observer) {
        ShadowMapGl map(device.context(), LitPointsGl::single_map, false);
        std::vector<Beam> beams;
        for (const EnvironmentBeam& part : environmentBeams(environment, options.beam_count, options.seed)) {
            if (observer.cancelled()) throw interruptedError();
            const gl::Buffer sums = device.sums();
            device.addDirection(map, part.wi, part.irradiance, options.eta, sums, shadowed);
            beams.push_back({{toFloat(part.wi)}, device.download(sums, 1)});
        }
        return beams;
    }
};

ProgressiveIrradianceGl::ProgressiveIrradianceGl(LitPointsGl& points, const Scene& scene,
                                                 const IrradianceOptions& options, Observer& observer)
    : impl_(new Impl(points, options)) {
    assert(options.beam_count >= 1 && options.light_samples >= 1 && options.disc_samples >= 1);
    for (const Light& light : scene.lights)
        std::visit([&](const auto& kind) { impl_->addLight(kind, observer); }, light);
}

ProgressiveIrradianceGl::~ProgressiveIrradianceGl() = default;
ProgressiveIrradianceGl::ProgressiveIrradianceGl(ProgressiveIrradianceGl&&) noexcept = default;
ProgressiveIrradianceGl& ProgressiveIrradianceGl::operator=(ProgressiveIrradianceGl&&) noexcept = default;

int ProgressiveIrradianceGl::samples() const { return impl_->occluded.empty() ? 0 : impl_->occluded.front()->samples; }

bool ProgressiveIrradianceGl::complete() const {
    return impl_->occluded.empty() || samples() >= impl_->options.light_samples;
}

void ProgressiveIrradianceGl::step(int count, Observer& observer) {
    LitPointsGl& device = impl_->device;
    for (int i = 0; i < count; ++i) {
        if (observer.cancelled()) throw interruptedError();
        for (const auto& light : impl_->occluded) {
            const auto [u, v] = light->sequence(static_cast<std::uint32_t>(light->samples));
            const EnvironmentSample chosen = light->environment->sample(u, v);
            if (chosen.pdf > 0)
                device.addDirection(device.sharedMap(), chosen.wi, (1 / chosen.pdf) * chosen.radiance,
                                    impl_->options.eta, light->sums);
            ++light->samples;
        }
    }
    observer.progress("irradiance", static_cast<std::uint64_t>(samples()),
                      static_cast<std::uint64_t>(impl_->options.light_samples), "light samples");
}

Irradiance ProgressiveIrradianceGl::result() const {
    Irradiance result = impl_->fixed;
    for (const auto& light : impl_->occluded) {
        std::vector<Rgbf> flux(result.transmitted.size());
        if (light->samples > 0) flux = impl_->device.download(light->sums, 1.0 / light->samples);
        for (std::size_t i = 0; i < flux.size(); ++i) add(result.transmitted[i], flux[i]);
        appendFitted(light->beams, impl_->points, flux, result.beams);
    }
    return result;
}

Irradiance computeIrradianceGl(LitPointsGl& points, const Scene& scene, const IrradianceOptions& options,
                               Observer& observer) {
    ProgressiveIrradianceGl irradiance(points, scene, options, observer);
    while (!irradiance.complete())
        irradiance.step(std::min(64, options.light_samples - irradiance.samples()), observer);
    return irradiance.result();
}

Irradiance computeIrradianceGl(gl::Context& context, const LitPoints& points, const Scene& scene, const Object& object,
                               bool shadows, const IrradianceOptions& options, Observer& observer) {
    LitPointsGl device(context, points, object, shadows);
    return computeIrradianceGl(device, scene, options, observer);
}

}  // namespace searchlight
