#include "transport/mesh/entry.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/directions.h"
#include "transport/mesh/closed_body.h"
#include "transport/walk/fresnel.h"

namespace searchlight {

namespace {

// Directions of uniform radiance by their cosine: the weight is pi.
Vec3 cosineDirection(Vec3 n, double u, double v) {
    return directionAround(n, std::sqrt(1 - u), 2 * std::numbers::pi * v);
}

}  // namespace

template <class Body>
EntrySource<Body>::EntrySource(const Body& body, const Illumination& illumination, const EntryOptions& options,
                               std::uint64_t candidates, SplitMix64 random)
    : body_(body), illumination_(illumination), options_(options), candidates_(candidates), random_(random) {}

template <class Body>
auto EntrySource<Body>::draw() -> Candidate {
    Candidate candidate;
    const double stratum = (static_cast<double>(tried_++) + random_.uniform()) / static_cast<double>(candidates_);
    if (const auto* pencil = std::get_if<PencilLight>(&illumination_)) {
        candidate.weight = 1;
        candidate.normal = pencil->normal;
        candidate.wi = pencil->wi;
        candidate.position = pencil->position;
        return candidate;
    }
    const SurfacePoint point =
        body_.pointAt(std::min(stratum, 0x1.fffffffffffffp-1), random_.uniform(), random_.uniform());
    candidate.position = point.position;
    candidate.normal = point.normal;
    const double u = random_.uniform(), v = random_.uniform(), w = random_.uniform();
    if (std::holds_alternative<UniformLight>(illumination_)) {
        candidate.weight = std::numbers::pi * body_.area();
        candidate.wi = cosineDirection(point.normal, u, v);
        return candidate;
    }
    const LightSample light = std::get<const LightSampler*>(illumination_)->sample(point.position, u, v, w);
    candidate.weight =
        body_.area() * light.irradiance_over_pdf[options_.channel] * std::max(0.0, dot(light.wi, point.normal));
    candidate.wi = light.wi;
    candidate.distance = light.distance;
    candidate.shadowed = true;
    candidate.single = light.pdf == 0;
    return candidate;
}

template <class Body>
bool EntrySource<Body>::next(Entry& entry) {
    while (tried_ < candidates_) {
        const Candidate candidate = draw();
        const double part = candidate.weight / options_.whole, weight = std::max(part, 1.0);
        if (!(part > 0) || (part < 1 && random_.uniform() >= part)) continue;
        const SurfacePoint point{candidate.position, candidate.normal};
        if (candidate.shadowed && body_.occluded(point, candidate.wi, candidate.distance)) continue;
        totals_.arrived += weight;
        ++totals_.arrivals;
        const double c = dot(candidate.wi, candidate.normal), eta = options_.eta;
        if (!(c > 0)) continue;  // grazing, by rounding
        const double sine2 = (1 - c) * (1 + c) / (eta * eta);
        if (eta != 1 && sine2 >= 1) continue;
        const double t = eta == 1 ? c : std::sqrt(1 - sine2);
        if (eta != 1 && random_.uniform() < fresnelReflectance(1, c, eta, t)) continue;
        totals_.entered += weight;
        ++totals_.walks;
        const Vec3 in = (-1 / eta) * candidate.wi + (c / eta - t) * candidate.normal;
        entry.direction = toFloat(normalize(in));
        entry.position = body_.below(point);
        entry.weight = static_cast<float>(weight);
        entry.single = candidate.single;
        return true;
    }
    return false;
}

template <class Body>
void EntrySource<Body>::leave(std::uint32_t, float weight, Vec3, const Crossing& crossing,
                              std::vector<CellExit>& exits) {
    exits.push_back({crossing.cell, weight});
}

template class EntrySource<Ball>;
template class EntrySource<MeshBody>;

}  // namespace searchlight
