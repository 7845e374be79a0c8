// Beams of discs: all directions that refraction leaves of them behind a facet.
#include <algorithm>

#include "transport/mesh/facet_beams.h"
#include "transport/mesh/facet_geometry.h"

namespace searchlight {

namespace {

// Directions between those that span a disc lie off by less than this times as much.
constexpr double kBetween = 1.1;

// Directions that span a disc.
std::vector<Vec3> spanOf(const LightSampler& lights, std::uint32_t light) {
    constexpr int around = 12;
    std::vector<Vec3> span;
    for (const double part : {0.0, 0.25, 1.0})  // of the solid angle
        for (int i = 0; i < (part > 0 ? around : 1); ++i)
            span.push_back(lights.sampleOf(light, {}, part, (i + 0.5) / around).wi);
    return span;
}

// What becomes of them behind a facet; for what is below the horizon what is at it. None where all the disc is below:
// between two directions of its edge it reaches a little higher.
std::vector<Vec3> refractedSpan(const std::vector<Vec3>& span, Vec3 normal, double eta) {
    constexpr double above = 1e-6;
    double radius = 0;
    for (const Vec3& wi : span) radius = std::max(radius, length(wi - span.front()));
    std::vector<Vec3> directions;
    bool lit = false;
    for (Vec3 wi : span) {
        const double cosine = dot(wi, normal);
        lit = lit || cosine > above - (kBetween - 1) * radius;
        if (cosine < above) wi = normalize(wi + (above - cosine) * normal);
        directions.push_back(refracted(wi, normal, eta));
    }
    if (!lit) directions.clear();
    return directions;
}

}  // namespace

void FacetBeams::addDisc(std::uint32_t light) {
    const Mesh& mesh = body_.mesh();
    spans_.resize(lights_.count());
    spans_[light] = spanOf(lights_, light);
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        const Vec3 normal = unitNormal(mesh, t);
        const std::vector<Vec3> directions = refractedSpan(spans_[light], normal, medium_.eta);
        if (directions.empty()) continue;
        Vec3 sum;
        for (const Vec3& direction : directions) sum = sum + direction;
        const Vec3 d = normalize(sum);
        const auto [a, b, c] = cornersOf(mesh, t);
        Beam beam;
        beam.triangle = t, beam.light = light, beam.parallel = beam.disc = true;
        beam.end = static_cast<float>(discReach_mm());
        if (!setRows(beam, {a, b - a, c - a, d})) continue;
        // How far off the facet's plane is met, over t.
        double off = 0;
        for (const Vec3& direction : directions) {
            const double down = std::min(dot(direction, normal), -1e-6);  // what is mirrored goes along the facet
            off = std::max(off, length((dot(d, normal) / down) * direction - d));
        }
        const Vec3 u = toDouble(beam.rows[0]), v = toDouble(beam.rows[1]);
        beam.slack = static_cast<float>(kBetween * off * std::max({length(u), length(v), length(u + v)}));
        beams_.push_back(beam);
    }
}

Sweep FacetBeams::sweepOfDisc(const Beam& beam) const {
    const auto corners = cornersOf(body_.mesh(), beam.triangle);
    Box facet{corners[0], corners[0]};
    for (const Vec3& corner : corners) facet.hold(corner);
    const auto spanned = refractedSpan(spans_[beam.light], unitNormal(body_.mesh(), beam.triangle), medium_.eta);
    Box directions{spanned[0], spanned[0]};
    for (const Vec3& d : spanned) directions.hold(d);
    const Vec3 between = (kBetween - 1) * length(directions.high - directions.low) * Vec3{1, 1, 1};
    return {facet, {directions.low - between, directions.high + between}, discReach_mm()};
}

}  // namespace searchlight
