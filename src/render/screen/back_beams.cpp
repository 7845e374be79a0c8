#include "render/screen/back_beams.h"

#include <algorithm>
#include <cmath>

#include "light/environment.h"
#include "light/environment_beams.h"
#include "light/single_lights.h"

namespace searchlight {

namespace {

class Beams {
public:
    Beams(const Object& object, const BackLightOptions& options) : object_(object), options_(options) {}

    void add(const DirectionalLight& light) {
        std::shared_ptr<const LightFilter> filter;
        if (!light.filter.empty())
            filter = std::make_shared<const LightFilter>(light.filter, light.direction, boundingRadius(object_));
        const DiscSamples disc = discSamples(light, options_.beam_count, options_.seed);
        for (const Vec3f& wi : disc.directions)
            beams_.push_back({.place = toDouble(wi), .irradiance = disc.weight * light.irradiance, .filter = filter});
    }
    void add(const PointLight& light) {
        beams_.push_back({.place = object_.longest_mm * light.position,
                          .from_point = true,
                          .irradiance = light.intensity,
                          .unit_mm = object_.longest_mm});
    }
    void add(const EnvironmentLight& light) {
        for (const EnvironmentBeam& part : environmentBeams(Environment(light), options_.beam_count, options_.seed))
            beams_.push_back({.place = part.wi, .irradiance = part.irradiance});
    }

    std::vector<BackBeam> take() { return std::move(beams_); }

private:
    const Object& object_;
    const BackLightOptions& options_;
    std::vector<BackBeam> beams_;
};

// The mesh's normal at a place on a triangle: interpolated where vertices have one.
Vec3 normalAt(const Mesh& mesh, std::uint32_t triangle, Vec3 place) {
    const auto& [a, b, c] = mesh.triangles[triangle];
    const Vec3 p0 = toDouble(mesh.positions[a]), from = place - p0;
    const Vec3 e1 = toDouble(mesh.positions[b]) - p0, e2 = toDouble(mesh.positions[c]) - p0;
    const Vec3 across = cross(e1, e2);
    const double square = dot(across, across);
    if (!(square > 0)) return {};
    const Vec3 geometric = (1 / std::sqrt(square)) * across;
    if (mesh.normals.empty()) return geometric;
    // A place that a shadow map found may lie a texel beside the triangle.
    const double u = std::clamp(dot(cross(from, e2), across) / square, 0.0, 1.0);
    const double v = std::clamp(dot(cross(e1, from), across) / square, 0.0, 1 - u);
    const Vec3 sum =
        (1 - u - v) * toDouble(mesh.normals[a]) + u * toDouble(mesh.normals[b]) + v * toDouble(mesh.normals[c]);
    return length(sum) > 0 ? normalize(sum) : geometric;
}

}  // namespace

std::vector<BackBeam> backBeams(const Scene& scene, const Object& object, const BackLightOptions& options) {
    Beams beams(object, options);
    for (const Light& light : scene.lights) std::visit([&](const auto& kind) { beams.add(kind); }, light);
    return beams.take();
}

LightThrough::LightThrough(const Object& object, const Profile& profile, double eta, double spacing_mm)
    : object_(object), profile_(profile), transmitted_cosine_(eta), total_(profile.total()), spacing_mm_(spacing_mm) {}

Rgb LightThrough::operator()(const BackBeam& beam, const WayOut& line) const {
    const Vec3 entry = line.from + line.out * line.wi;
    const double cosine = dot(normalAt(object_.mesh, line.triangle, entry), line.wi);
    if (cosine <= 0) return {};
    Rgb flux = static_cast<double>(transmitted_cosine_(static_cast<float>(cosine))) * beam.irradiance;
    if (beam.filter) flux = flux * (*beam.filter)(entry, spacing_mm_);
    if (beam.from_point) flux = std::pow(beam.unit_mm / line.behind, 2) * flux;
    return flux * (total_ - profile_.encircled(line.way));
}

}  // namespace searchlight
