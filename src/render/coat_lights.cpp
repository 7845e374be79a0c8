#include "render/coat_lights.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <variant>

#include "light/disc.h"
#include "light/environment.h"
#include "light/light_filter.h"
#include "light/stratified.h"

namespace searchlight {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// A single direction or a disc.
struct Sky {
    Disc disc;
    Vec3 centre;
    Rgb irradiance;
    double chord2 = 0;  // squared distance of unit vectors from the centre to the disc's edge
    std::optional<LightFilter> filter;

    Rgb radiance() const { return (disc.weight() / disc.solidAngle()) * irradiance; }
    bool holds(Vec3 wi) const { return dot(wi - centre, wi - centre) <= chord2; }
    Rgb passed(Vec3 position) const { return filter ? (*filter)(position, 0) : Rgb{1, 1, 1}; }
};

struct Point {
    Vec3 position;  // mm
    Rgb intensity;  // times mm^2: irradiance at a distance in mm
};

struct Surroundings {
    Environment environment;
    bool occlusion;
};

Sky skyOf(const DirectionalLight& light, const Object& object) {
    const double quarter = 0.25 * light.angle_deg * std::numbers::pi / 180;
    Sky sky{Disc(light), normalize(light.direction), light.irradiance, 4 * std::pow(std::sin(quarter), 2), {}};
    if (!light.filter.empty()) sky.filter.emplace(light.filter, light.direction, length(object.half_extent));
    return sky;
}

}  // namespace

struct CoatLights::Impl {
    std::vector<std::variant<Sky, Point, Surroundings>> lights;
    const RayScene* rays;
    CoatOptions options;

    bool visible(const CoatPoint& point, Vec3 wi, double distance) const {
        if (!rays) return true;
        if (dot(wi, point.geometric_normal) <= 0) return false;
        const Vec3f origin = rays->offsetOrigin(toFloat(point.position), toFloat(point.geometric_normal));
        return !rays->occluded(Ray{origin, toFloat(wi), 0, static_cast<float>(distance)});
    }

    using Take = std::function<void(Vec3, Rgb)>;

    void gather(const Sky& sky, const CoatPoint& point, std::uint64_t seed, const CoatChoice& choice,
                const Take& take) const {
        if (sky.chord2 == 0) {
            const Vec3 wi = point.local(sky.centre);
            if (wi.z > 0 && visible(point, sky.centre, infinity))
                take(wi, wi.z * (sky.irradiance * sky.passed(point.position)));
            return;
        }
        const Rgb radiance = sky.radiance() * sky.passed(point.position);
        const double disc_pdf = 1 / sky.disc.solidAngle();
        const auto add = [&](Vec3 wi, Vec3 world, double density) {
            if (wi.z > 0 && visible(point, world, infinity)) take(wi, (wi.z / density) * radiance);
        };
        const StratifiedSequence sequence(seed);
        const int by_light = (options.disc_samples + 1) / 2, by_choice = options.disc_samples / 2;
        for (int i = 0; i < by_light + by_choice; ++i) {
            const auto [u, v] = sequence(static_cast<std::uint32_t>(i));
            if (i < by_light) {
                const Vec3 world = sky.disc.sample(u, v), wi = point.local(world);
                add(wi, world, by_light * disc_pdf + by_choice * choice.pdf(wi));
            } else {
                const Vec3 wi = choice.sample(u, v), world = point.world(wi);
                if (sky.holds(world)) add(wi, world, by_light * disc_pdf + by_choice * choice.pdf(wi));
            }
        }
    }

    void gather(const Point& light, const CoatPoint& point, std::uint64_t, const CoatChoice&, const Take& take) const {
        const Vec3 to_light = light.position - point.position;
        const double distance = length(to_light);
        if (distance == 0) return;
        const Vec3 world = (1 / distance) * to_light, wi = point.local(world);
        if (wi.z > 0 && visible(point, world, distance)) take(wi, (wi.z / (distance * distance)) * light.intensity);
    }

    void gather(const Surroundings& light, const CoatPoint& point, std::uint64_t seed, const CoatChoice& choice,
                const Take& take) const {
        const Environment& environment = light.environment;
        const int by_light = (options.picture_samples + 1) / 2, by_choice = options.picture_samples / 2;
        const auto add = [&](Vec3 wi, Vec3 world, Rgb radiance, double picture_pdf) {
            if (wi.z <= 0 || (light.occlusion && !visible(point, world, infinity))) return;
            const double density = by_light * picture_pdf + by_choice * choice.pdf(wi);
            if (density > 0) take(wi, (wi.z / density) * radiance);
        };
        // Two sequences, so that each is stratified of itself.
        const StratifiedSequence for_light(seed), for_choice(~seed);
        for (int i = 0; i < by_light; ++i) {
            const auto [u, v] = for_light(static_cast<std::uint32_t>(i));
            const EnvironmentSample sample = environment.sample(u, v);
            if (sample.pdf > 0) add(point.local(sample.wi), sample.wi, sample.radiance, sample.pdf);
        }
        for (int i = 0; i < by_choice; ++i) {
            const auto [u, v] = for_choice(static_cast<std::uint32_t>(i));
            const Vec3 wi = choice.sample(u, v), world = point.world(wi);
            if (wi.z > 0) add(wi, world, environment.radiance(world), environment.pdf(world));
        }
    }
};

CoatLights::CoatLights(const Scene& scene, const Object& object, const RayScene* rays, const CoatOptions& options)
    : impl_(std::make_unique<Impl>()) {
    impl_->rays = rays;
    impl_->options = options;
    for (const Light& light : scene.lights) {
        if (const auto* sky = std::get_if<DirectionalLight>(&light)) {
            impl_->lights.emplace_back(skyOf(*sky, object));
        } else if (const auto* point = std::get_if<PointLight>(&light)) {
            const double unit = object.longest_mm;
            impl_->lights.emplace_back(Point{unit * point->position, (unit * unit) * point->intensity});
        } else if (const auto* picture = std::get_if<EnvironmentLight>(&light)) {
            impl_->lights.emplace_back(Surroundings{Environment(*picture), picture->occlusion});
        }
    }
}

CoatLights::~CoatLights() = default;

void CoatLights::gather(const CoatPoint& point, std::uint64_t seed, const CoatChoice& choice,
                        const std::function<void(Vec3, Rgb)>& take) const {
    for (const auto& light : impl_->lights)
        std::visit([&](const auto& kind) { impl_->gather(kind, point, seed++, choice, take); }, light);
}

Rgb CoatLights::radianceFrom(const CoatPoint& point, Vec3 wi) const {
    const Vec3 world = point.world(wi);
    Rgb sum;
    for (const auto& light : impl_->lights) {
        if (const auto* sky = std::get_if<Sky>(&light)) {
            if (sky->chord2 > 0 && sky->holds(world) && impl_->visible(point, world, infinity))
                sum = sum + sky->radiance() * sky->passed(point.position);
        } else if (const auto* picture = std::get_if<Surroundings>(&light)) {
            if (!picture->occlusion || impl_->visible(point, world, infinity))
                sum = sum + picture->environment.radiance(world);
        }
    }
    return sum;
}

}  // namespace searchlight
