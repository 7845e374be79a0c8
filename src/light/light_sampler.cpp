#include "light/light_sampler.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "light/disc.h"
#include "light/environment.h"
#include "light/light_filter.h"
#include "light/single_lights.h"

namespace searchlight {

namespace {

constexpr double kNarrow_deg = 40;

class DirectionalSource {
public:
    DirectionalSource(const DirectionalLight& light, const Object& object) : light_(light), disc_(light) {
        if (!light.filter.empty()) filter_.emplace(light.filter, light.direction, boundingRadius(object));
    }

    double power() const { return luminance(light_.irradiance); }

    LightSample sample(Vec3 position, double u, double v) const {
        LightSample sample{disc_.sample(u, v), disc_.weight() * light_.irradiance};
        if (filter_) sample.irradiance_over_pdf = sample.irradiance_over_pdf * (*filter_)(position, 0);
        if (disc_.solidAngle() > 0) sample.pdf = 1 / disc_.solidAngle();
        return sample;
    }

    bool singular() const { return disc_.solidAngle() == 0; }
    bool narrow() const { return !singular() && light_.angle_deg <= kNarrow_deg; }

    Rgb radiance(Vec3 position, Vec3 direction) const {
        if (!disc_.holds(direction)) return {};
        const Rgb radiance = (disc_.weight() / disc_.solidAngle()) * light_.irradiance;
        return filter_ ? radiance * (*filter_)(position, 0) : radiance;
    }

private:
    DirectionalLight light_;
    Disc disc_;
    std::optional<LightFilter> filter_;
};

class EnvironmentSource {
public:
    EnvironmentSource(const EnvironmentLight& light, const Object&) : environment_(light) {}

    // A quarter of what falls on a sphere counts as on a surface that faces it.
    double power() const { return 0.25 * luminance(environment_.totalRadiance()); }

    LightSample sample(Vec3, double u, double v) const {
        const EnvironmentSample chosen = environment_.sample(u, v);
        LightSample sample{chosen.wi, {}, chosen.pdf};
        if (chosen.pdf > 0) sample.irradiance_over_pdf = (1 / chosen.pdf) * chosen.radiance;
        return sample;
    }

    bool singular() const { return false; }
    bool narrow() const { return false; }

    Rgb radiance(Vec3, Vec3 direction) const { return environment_.radiance(direction); }

private:
    Environment environment_;
};

class PointSource {
public:
    PointSource(const PointLight& light, const Object& object)
        : light_(light),
          unit_mm_(object.longest_mm),
          place_(unit_mm_ * light.position),
          nearest_mm_(boundingRadius(object)) {}

    // Within the object's sphere as if on it: the inverse square has no bound there.
    double power() const {
        const double distance = std::max(length(place_), nearest_mm_);
        return luminance(light_.intensity) * std::pow(unit_mm_ / distance, 2);
    }

    LightSample sample(Vec3 position, double, double) const {
        const Vec3 to_light = place_ - position;
        const double distance = length(to_light);
        if (distance == 0) return {};
        return {(1 / distance) * to_light, std::pow(unit_mm_ / distance, 2) * light_.intensity, 0, distance};
    }

    bool singular() const { return true; }
    bool narrow() const { return false; }

    Rgb radiance(Vec3, Vec3) const { return {}; }

private:
    PointLight light_;
    double unit_mm_;
    Vec3 place_;
    double nearest_mm_;
};

using Source = std::variant<DirectionalSource, EnvironmentSource, PointSource>;

Source makeSource(const DirectionalLight& light, const Object& object) { return DirectionalSource(light, object); }
Source makeSource(const EnvironmentLight& light, const Object& object) { return EnvironmentSource(light, object); }
Source makeSource(const PointLight& light, const Object& object) { return PointSource(light, object); }

}  // namespace

struct LightSampler::Impl {
    std::vector<Source> sources;
    std::vector<double> cumulative;  ///< probability of the sources up to and with this one; the last is 1
};

LightSampler::LightSampler(const Scene& scene, const Object& object) : impl_(std::make_unique<Impl>()) {
    double total = 0;
    for (const Light& light : scene.lights) {
        Source source = std::visit([&](const auto& kind) { return makeSource(kind, object); }, light);
        const double power = std::visit([](const auto& kind) { return kind.power(); }, source);
        if (!(power > 0)) continue;
        total += power;
        impl_->sources.push_back(std::move(source));
        impl_->cumulative.push_back(total);
    }
    for (double& value : impl_->cumulative) value /= total;
}

LightSampler::~LightSampler() = default;
LightSampler::LightSampler(LightSampler&&) noexcept = default;
LightSampler& LightSampler::operator=(LightSampler&&) noexcept = default;

bool LightSampler::dark() const { return impl_->sources.empty(); }

Rgb LightSampler::radiance(Vec3 position, Vec3 direction, bool wide_only) const {
    Rgb sum;
    for (std::size_t light = 0; light < count(); ++light)
        if (!(wide_only && narrow(light)))
            sum = sum + std::visit([&](const auto& source) { return source.radiance(position, direction); },
                                   impl_->sources[light]);
    return sum;
}

std::size_t LightSampler::count() const { return impl_->sources.size(); }

bool LightSampler::singular(std::size_t light) const {
    return std::visit([](const auto& source) { return source.singular(); }, impl_->sources[light]);
}

bool LightSampler::narrow(std::size_t light) const {
    return std::visit([](const auto& source) { return source.narrow(); }, impl_->sources[light]);
}

bool LightSampler::narrow() const {
    for (std::size_t light = 0; light < count(); ++light)
        if (narrow(light)) return true;
    return false;
}

bool LightSampler::singular() const {
    for (std::size_t light = 0; light < count(); ++light)
        if (singular(light)) return true;
    return false;
}

LightSample LightSampler::sampleOf(std::size_t light, Vec3 position, double u, double v) const {
    return std::visit([&](const auto& source) { return source.sample(position, u, v); }, impl_->sources[light]);
}

LightSample LightSampler::sample(Vec3 position, double u_light, double u, double v) const {
    if (dark()) return {};
    const std::vector<double>& cumulative = impl_->cumulative;
    const auto chosen = std::min<std::ptrdiff_t>(std::ranges::upper_bound(cumulative, u_light) - cumulative.begin(),
                                                 std::ssize(cumulative) - 1);
    const double probability = cumulative[chosen] - (chosen > 0 ? cumulative[chosen - 1] : 0);
    LightSample sample = sampleOf(static_cast<std::size_t>(chosen), position, u, v);
    sample.irradiance_over_pdf = (1 / probability) * sample.irradiance_over_pdf;
    sample.pdf *= probability;
    return sample;
}

}  // namespace searchlight
