#include "transport/mesh/sphere_beams.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "model/physics.h"
#include "transport/mesh/sphere_rays.h"
#include "transport/walk/fresnel.h"

namespace searchlight {

namespace {

constexpr double pi = std::numbers::pi;
// Collisions that little light reaches are followed up by a roulette.
constexpr double kWeak = 0.2;
// Rays that are drawn: of an order with probability 1/((order + 1) (order + 2)), up to here.
constexpr int kMostDrawn = 60;
// Light about the axis is mirrored light, but for eta > 1.4.
constexpr double kAxisPart = 0.2;

}  // namespace

// In radii of the sphere.
struct SphereBeams::Flight {
    Vec3 from, direction;
    double end = 0;  // to the surface

    Vec3 at(double way) const { return from + way * direction; }
};

// A ray at a place, in radii of the sphere.
struct SphereBeams::Pass {
    int order = 0;
    double i = 0, gamma = 0, t = 0;      // angles of incidence, at the light, of refraction
    double r = 0, cosine = 0, sine = 0;  // the place, and of the angle psi there between the ray and the way outwards
    double slope = 0;                    // of the angle that it has turned by, over psi
    double off_axis = 0;                 // sine of the place's polar angle
    Vec3 side;                           // unit, across the axis: of its plane the half where it entered
    Vec3 towards;                        // unit, where it goes
};

namespace {

// Where a flight is near an axis: the distance from that is sqrt(a x^2 + 2 b x + c).
struct AboutAxis {
    double a = 0, b = 0, c = 0;

    AboutAxis(Vec3 from, Vec3 direction, Vec3 axis) {
        const Vec3 p = from - dot(from, axis) * axis, d = direction - dot(direction, axis) * axis;
        a = std::max(dot(d, d), 1e-12), b = dot(p, d), c = dot(p, p);
    }

    double distance(double x) const { return std::sqrt(std::max(1e-30, (a * x + 2 * b) * x + c)); }
    // Integral of 1/distance from 0, and where it has a value.
    double root() const { return std::sqrt(std::max(1e-20, a * c - b * b)); }
    double integral(double x) const {
        return (std::asinh((a * x + b) / root()) - std::asinh(b / root())) / std::sqrt(a);
    }
    double reached(double integral) const {
        return (root() * std::sinh(std::sqrt(a) * integral + std::asinh(b / root())) - b) / a;
    }
};

}  // namespace

SphereBeams::SphereBeams(const Ball& body, const BodyMedium& medium, const LightSampler& lights, int channel,
                         bool along)
    : radius_(body.radius()), medium_(medium), lights_(lights), channel_(channel) {
    for (std::size_t light = 0; light < lights.count(); ++light) {
        if (!lights.singular(light)) continue;
        const LightSample sample = lights.sampleOf(light, {}, 0.5, 0.5);
        if (sample.distance > radius_) sources_.push_back({light, sample.wi, radius_ / sample.distance});
    }
    // Of eta > 1: no chord is shorter.
    shortest_chord_ = medium.eta > 1 ? 2 * radius_ * criticalCosine(medium.eta) : 0;
    // Refracted rays have run half their chord where they meet on a caustic, mirrored ones more: where nothing gets
    // that far, nothing is gained.
    if (along && !sources_.empty()) ray_part_ = std::exp(-0.5 * medium.sigma_t * shortest_chord_);
    if (ray_part_ < 1e-3) ray_part_ = 0;
    axis_part_ = kAxisPart * ray_part_;
}

// An order is followed with the probability of this times the loss by the shortest chords: falls slowly enough for
// grazing light, of which hardly any gets out: T12 F^order is at most 1/(e order).
double SphereBeams::followed(int order) const {
    if (order == 0) return 1;
    return 0.4 * std::exp(-medium_.sigma_t * order * shortest_chord_) / ((order + 1.0) * (order + 1.0));
}

SphereBeams::Flight SphereBeams::flightOf(Vec3f from, Vec3 direction) const {
    const Vec3 begin = (1 / radius_) * toDouble(from);
    const double b = dot(begin, direction), c = dot(begin, begin) - 1;
    return {begin, direction, -b + std::sqrt(std::max(0.0, b * b - c))};
}

double SphereBeams::atCollision(Vec3f from, Vec3 direction, double length_mm, SplitMix64& random) const {
    const Flight flight = flightOf(from, direction);
    const double way = length_mm / radius_;
    // No light has come a shorter way.
    const double depth = radius_ * (1 - length(flight.at(way)));
    if (random.uniform() * kWeak >= std::exp(-medium_.sigma_t * depth)) return 0;
    return allRays(flight, way, random);
}

double SphereBeams::alongFlight(Vec3f from, Vec3 direction, SplitMix64& random) const {
    if (ray_part_ == 0) return 0;
    const double chosen = random.uniform();
    if (chosen >= ray_part_) return 0;
    const Flight flight = flightOf(from, direction);
    if (!(flight.end > 1e-9)) return 0;
    double sum = oneRay(flight, random);
    if (chosen < axis_part_) {
        const Source& source = sources_[random.next() % sources_.size()];
        const AboutAxis about(flight.from, direction, source.axis);
        sum += allRays(flight, about.reached(random.uniform() * about.integral(flight.end)), random);
    }
    return sum;
}

// All rays, of orders that are drawn, at a place of a flight.
double SphereBeams::allRays(const Flight& flight, double at, SplitMix64& random) const {
    const double u = random.uniform();
    const Vec3 place = flight.at(at);
    double sum = 0;
    Pass pass;
    pass.r = std::min(1.0, length(place));
    for (pass.order = 0; u < followed(pass.order); ++pass.order)
        for (const Source& source : sources_) {
            const Vec3 up = place - dot(place, source.axis) * source.axis;
            const double away = length(up), phi = std::atan2(away, dot(place, source.axis));
            if (!(away > 0)) continue;  // on the axis: a line
            const Vec3 across = (1 / away) * up, outwards = (1 / length(place)) * place;
            const Vec3 onwards = std::cos(phi) * across - std::sin(phi) * source.axis;
            pass.off_axis = std::sin(phi);
            for (const bool leaving : {false, true})
                forEachRay(SphereRays(medium_.eta, pass.r, source.nearness, pass.order, leaving), phi,
                           [&](const SphereRays::Ray& ray, double side) {
                               pass.i = ray.i, pass.gamma = ray.gamma, pass.t = ray.t;
                               pass.cosine = leaving ? std::cos(ray.chi) : -std::cos(ray.chi);
                               pass.sine = ray.sine;
                               pass.slope = ray.slope / ray.per_chi;
                               pass.side = side * across;
                               pass.towards = pass.cosine * outwards + side * ray.sine * onwards;
                               sum += weighted(source, flight, at, pass);
                           });
        }
    return sum;
}

// One ray, turned about the axis so that the flight meets it, where it does.
double SphereBeams::oneRay(const Flight& flight, SplitMix64& random) const {
    const Source& source = sources_[random.next() % sources_.size()];
    const double drawn = 1 / random.uniform() - 1, s = std::min(1.0, medium_.eta) * std::sqrt(random.uniform());
    if (drawn >= kMostDrawn) return 0;
    Pass pass;
    pass.order = static_cast<int>(drawn);
    pass.i = std::asin(s), pass.gamma = std::asin(s * source.nearness), pass.t = std::asin(s / medium_.eta);
    // Its last chord, in its plane: from where to where, by distance from the axis and height along it. Turned about
    // the axis it is a cone, which a line meets twice.
    const double begin = pass.i - pass.gamma + pass.order * (pi - 2 * pass.t), to = begin - pass.t;
    const double x = std::sin(begin), z = std::cos(begin), dx = -std::sin(to), dz = -std::cos(to);
    const double moment = -std::sin(pass.t);
    const double height = dot(flight.from, source.axis), climb = dot(flight.direction, source.axis);
    const Vec3 p = flight.from - height * source.axis, d = flight.direction - climb * source.axis;
    const double a = dz * dz * dot(d, d) - dx * dx * climb * climb;
    const double b = dz * dz * dot(p, d) - dx * climb * (moment + height * dx);
    const double c = dz * dz * dot(p, p) - (moment + height * dx) * (moment + height * dx);
    const double discriminant = b * b - a * c;
    if (!(discriminant > 0) || a == 0) return 0;
    const double q = -(b + std::copysign(std::sqrt(discriminant), b));
    double sum = 0;
    for (const double at : {q / a, c / q}) {
        if (!(at > 0 && at < flight.end)) continue;
        const Vec3 place = flight.at(at);
        const double level = dot(place, source.axis);
        const Vec3 up = place - level * source.axis;
        const double away = length(up),
                     along = dx * std::copysign(away, (moment + level * dx) * dz) + dz * level - (dx * x + dz * z);
        if (!(along > 0 && along < 2 * std::cos(pass.t) && away > 0)) continue;
        pass.side = (std::copysign(1.0, (moment + level * dx) * dz) / away) * up;
        pass.towards = dx * pass.side + dz * source.axis;
        pass.r = length(place);
        pass.cosine = dot(pass.towards, place) / pass.r;
        pass.sine = s / (medium_.eta * pass.r);
        pass.off_axis = away / pass.r;
        const double n = s / pass.sine;
        pass.slope = pass.cosine * (n / std::cos(pass.i) - n * source.nearness / std::cos(pass.gamma) -
                                    (2 * pass.order + 1) * pass.r / std::cos(pass.t)) -
                     1;
        sum += weighted(source, flight, at, pass);
    }
    return sum;
}

// What a ray brings to a place of a flight, over the density of such places by all the ways of asking, in terms of that
// of collisions.
double SphereBeams::weighted(const Source& source, const Flight& flight, double at, const Pass& pass) const {
    const double t = std::cos(pass.t), mirrored = fresnelReflectance(1, std::cos(pass.i), medium_.eta, t);
    const Vec3 entry =
        radius_ * (std::cos(pass.i - pass.gamma) * source.axis + std::sin(pass.i - pass.gamma) * pass.side);
    const LightSample light = lights_.sampleOf(source.light, entry, 0.5, 0.5);
    // Radiance over the square of the index stays: irradiance is in proportion to the solid angle at the place over
    // that at the light, sin(psi) dpsi over sin(Phi) dPhi.
    double value = light.irradiance_over_pdf[channel_] * (1 - mirrored) * std::pow(mirrored, pass.order) * pass.sine /
                   (pass.off_axis * std::abs(pass.slope));
    if (source.nearness > 0) value *= std::pow(light.distance * source.nearness / radius_, 2) / std::cos(pass.gamma);
    const double way = radius_ * ((2 * pass.order + 1) * t + pass.r * pass.cosine);
    value *= std::exp(-medium_.sigma_t * way) *
             Physics<double>::henyeyGreenstein(-dot(flight.direction, pass.towards), medium_.g);

    const double order = followed(pass.order);
    double density = order * std::min(1.0, std::exp(-medium_.sigma_t * radius_ * (1 - pass.r)) / kWeak);
    if (ray_part_ > 0) {
        const double collisions =
            medium_.sigma_t * radius_ * (1 - medium_.absorbed) * std::exp(-medium_.sigma_t * radius_ * at);
        const double chosen = 1 / static_cast<double>(sources_.size());
        double others = 0;
        if (pass.order < kMostDrawn) {
            // Rays of the sine s, drawn as 2 s / most^2: ds along the flight.
            const Vec3 normal = cross(cross(pass.side, source.axis), pass.towards);
            const double most = std::min(1.0, medium_.eta), s = medium_.eta * pass.r * pass.sine;
            others += ray_part_ * chosen / ((pass.order + 1.0) * (pass.order + 2.0)) * 2 * s / (most * most) *
                      medium_.eta * std::abs(dot(flight.direction, normal) / pass.slope);
        }
        for (const Source& about : sources_) {
            const AboutAxis axis(flight.from, flight.direction, about.axis);
            others += axis_part_ * chosen * order / (axis.distance(at) * axis.integral(flight.end));
        }
        density += others / collisions;
    }
    return density > 0 && std::isfinite(value) ? value / density : 0;
}

}  // namespace searchlight
