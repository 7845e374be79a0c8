#include "transport/mesh/entry.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/directions.h"
#include "transport/mesh/closed_body.h"
#include "transport/mesh/entry_lanes.h"

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

// All but the direction of uniform radiance.
template <class Body>
auto EntrySource<Body>::drawPoint() -> Candidate {
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
    if (std::holds_alternative<UniformLight>(illumination_)) {
        candidate.weight = std::numbers::pi * body_.area();
        return candidate;
    }
    const double u = random_.uniform(), v = random_.uniform(), w = random_.uniform();
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
auto EntrySource<Body>::draw() -> Candidate {
    Candidate candidate = drawPoint();
    if (std::holds_alternative<UniformLight>(illumination_))
        candidate.wi = cosineDirection(candidate.normal, random_.uniform(), random_.uniform());
    return candidate;
}

template <class Body>
bool EntrySource<Body>::next(Entry& entry) {
    while (entries_.empty())
        if (!fill()) return false;
    entry = entries_.back();
    entries_.pop_back();
    return true;
}

template <class Body>
bool EntrySource<Body>::fill() {
    if (tried_ >= candidates_) return false;
    const auto word = [this] { return static_cast<std::int32_t>(random_.next() >> 32); };
    Candidate drawn[EntryLanes::kMost];
    double weights[EntryLanes::kMost];
    Shadow shadows[EntryLanes::kMost];
    std::size_t count = 0, asked = 0;
    while (count < EntryLanes::kMost && tried_ < candidates_) {
        const Candidate candidate = drawPoint();
        const double part = candidate.weight / options_.whole;
        if (!(part > 0) || (part < 1 && random_.uniform() >= part)) continue;
        if (candidate.shadowed)
            shadows[asked++] = {{candidate.position, candidate.normal}, candidate.wi, candidate.distance};
        weights[count] = std::max(part, 1.0);
        drawn[count++] = candidate;
    }
    std::uint8_t hidden[EntryLanes::kMost];
    if (asked > 0) body_.occluded(std::span<const Shadow>(shadows, asked), hidden);
    EntryLanes lanes;
    asked = 0;
    for (std::size_t i = 0; i < count; ++i) {
        if (drawn[i].shadowed && hidden[asked++] != 0) continue;
        const Vec3f n = toFloat(drawn[i].normal), wi = toFloat(drawn[i].wi);
        const std::size_t lane = lanes.count++;
        drawn[lane] = drawn[i], weights[lane] = weights[i];
        lanes.nx[lane] = n.x, lanes.ny[lane] = n.y, lanes.nz[lane] = n.z;
        lanes.wx[lane] = wi.x, lanes.wy[lane] = wi.y, lanes.wz[lane] = wi.z;
        lanes.bits[lane] = word();
    }
    if (std::holds_alternative<UniformLight>(illumination_)) {
        alignas(64) std::int32_t heights[EntryLanes::kMost] = {}, turns[EntryLanes::kMost] = {};
        for (std::size_t i = 0; i < lanes.count; ++i) heights[i] = word(), turns[i] = word();
        drawDiffuse(lanes, heights, turns);
    }
    refractInwards(lanes, options_.eta);
    for (std::size_t i = lanes.count; i-- > 0;) {
        totals_.arrived += weights[i];
        ++totals_.arrivals;
        if ((lanes.enters >> i & 1) == 0) continue;
        totals_.entered += weights[i];
        ++totals_.walks;
        Entry entry;
        entry.direction = {lanes.dx[i], lanes.dy[i], lanes.dz[i]};
        entry.position = body_.below({drawn[i].position, drawn[i].normal});
        entry.weight = static_cast<float>(weights[i]);
        entry.single = drawn[i].single;
        entries_.push_back(entry);
    }
    return true;
}

template <class Body>
void EntrySource<Body>::leave(std::uint32_t, float weight, Vec3, const Crossing& crossing,
                              std::vector<CellExit>& exits) {
    exits.push_back({crossing.cell, weight});
}

template class EntrySource<Ball>;
template class EntrySource<MeshBody>;

}  // namespace searchlight
