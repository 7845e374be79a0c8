// Beams of discs: all directions that refraction leaves of them behind a facet.
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "model/physics.h"
#include "transport/mesh/facet_beams.h"
#include "transport/mesh/facet_geometry.h"
#include "transport/walk/fresnel.h"

namespace searchlight {

namespace {

// Directions between those that span a disc lie off by less than this times as much.
constexpr double kBetween = 1.1;
// The same of what a linear function of the direction leaves: it goes round the disc's edge in waves of a half and a
// third, of which directions 30 degrees apart meet cos(45 degrees) at least.
constexpr double kBetweenFits = 1.5;

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
        gates_.push_back(gateOf(beam, directions));
    }
    disc_ends_.push_back({static_cast<std::uint32_t>(beams_.size()), light});
}

// `directions`: what becomes of those that span the disc.
DiscGate FacetBeams::gateOf(const Beam& beam, std::span<const Vec3> directions) const {
    DiscGate gate;
    const auto set = [](float* column, double u, double v, double whole, double rest) {
        column[0] = static_cast<float>(u), column[1] = static_cast<float>(v);
        column[2] = static_cast<float>(whole - u - v), column[3] = static_cast<float>(rest);
    };
    const Vec3 rows[]{toDouble(beam.rows[0]), toDouble(beam.rows[1]), toDouble(beam.rows[2])};
    set(gate.place[0], rows[0].x, rows[1].x, 0, rows[2].x);
    set(gate.place[1], rows[0].y, rows[1].y, 0, rows[2].y);
    set(gate.place[2], rows[0].z, rows[1].z, 0, rows[2].z);
    set(gate.place[3], static_cast<double>(beam.constants[0]), static_cast<double>(beam.constants[1]), 1,
        static_cast<double>(beam.constants[2]));

    // How far off it enters is nearly a linear function of the direction, fitted to those that span the disc.
    const std::vector<Vec3>& span = spans_[beam.light];
    Vec3 slope[2];
    double begin[2], error = 0;
    const Vec3 axis = span.front();
    for (const int k : {0, 1}) {
        const auto off = [&](std::size_t i) { return dot(rows[k], directions[i]) / dot(rows[2], directions[i]); };
        double square = 0;  // mean of one coordinate's, as directions go round the axis
        for (std::size_t i = 0; i < span.size(); ++i) {
            const Vec3 side = span[i] - dot(span[i], axis) * axis;
            slope[k] = slope[k] + off(i) * side;
            square += 0.5 * dot(side, side);
        }
        slope[k] = (1 / square) * slope[k];
        double least = std::numeric_limits<double>::infinity(), most = -least;
        for (std::size_t i = 0; i < span.size(); ++i) {
            const double rest = off(i) - dot(slope[k], span[i]);
            least = std::min(least, rest), most = std::max(most, rest);
        }
        begin[k] = 0.5 * (least + most);
        error += kBetweenFits * 0.5 * (most - least);  // of u, v, and u + v
    }
    if (error < static_cast<double>(beam.slack)) {
        set(gate.towards[0], slope[0].x, slope[1].x, 0, 0);
        set(gate.towards[1], slope[0].y, slope[1].y, 0, 0);
        set(gate.towards[2], slope[0].z, slope[1].z, 0, 0);
        set(gate.towards[3], begin[0], begin[1], 0, error);
    } else {
        gate.towards[3][3] = beam.slack;
    }
    return gate;
}

double FacetBeams::fromDiscs(std::span<const std::uint32_t> list, const Collision& collision, SplitMix64& random,
                             std::uint64_t& rays) const {
    double sum = 0;
    while (!list.empty()) {
        // One direction of each disc. Its beams follow one another.
        const auto end = std::ranges::upper_bound(disc_ends_, list.front(), {}, &DiscEnd::beam);
        const std::uint32_t disc = end->light;
        const auto count = static_cast<std::size_t>(std::ranges::lower_bound(list, end->beam) - list.begin());
        const double u = random.uniform(), v = random.uniform();
        const LightSample light = lights_.sampleOf(disc, toDouble(collision.position), u, v);
        const DiscPlace place{collision.position, toFloat(light.wi)};
        for (std::size_t at = 0; at < count; at += kGatesAtOnce) {
            const auto some = list.subspan(at, std::min(kGatesAtOnce, count - at));
            for (std::uint64_t open = openGates(gates_, some, place, static_cast<float>(kFacetMargin)); open != 0;
                 open &= open - 1)
                sum += byDisc(some[static_cast<std::size_t>(std::countr_zero(open))], light, collision, random, rays);
        }
        list = list.subspan(count);
    }
    return sum;
}

// All that is needed of the beam but for its rays is in its gate.
double FacetBeams::byDisc(std::uint32_t beam, const LightSample& light, const Collision& collision, SplitMix64& random,
                          std::uint64_t& rays) const {
    const auto& place = gates_[beam].place;
    const auto row = [&](int k) {
        return Vec3{static_cast<double>(place[0][k]), static_cast<double>(place[1][k]),
                    static_cast<double>(place[2][k])};
    };
    const Vec3 position = toDouble(collision.position), across = row(3);
    const double scale = 1 / length(across), eta = medium_.eta;
    const Vec3 normal = -scale * across;
    const double depth = scale * (dot(across, position) + static_cast<double>(place[3][3]));
    const double outside = dot(light.wi, normal), square = 1 - (1 - outside) * (1 + outside) / (eta * eta);
    if (!(depth > 0 && outside > 0 && square > 0)) return 0;
    const double inside = std::sqrt(square);
    Arrival arrival;
    arrival.wi = light.wi;
    arrival.light_distance = light.distance;
    arrival.direction = (-1 / eta) * light.wi + (outside / eta - inside) * normal;
    arrival.distance = depth / inside;
    if (arrival.distance >= discReach_mm()) return 0;
    arrival.entry = position - arrival.distance * arrival.direction;
    const double u = dot(row(0), arrival.entry) + static_cast<double>(place[3][0]);
    const double v = dot(row(1), arrival.entry) + static_cast<double>(place[3][1]);
    if (!(u >= 0 && v >= 0 && u + v <= 1)) return 0;
    const double left = std::exp(-medium_.sigma_t * arrival.distance);
    if (left < kWeak && random.uniform() * kWeak >= left) return 0;
    const Clearance clear = clearances_[beam];
    if ((arrival.distance >= static_cast<double>(clear.inside_mm) || !clear.outside) &&
        hidden(beam, collision.position, arrival, rays))
        return 0;
    return light.irradiance_over_pdf[channel_] * (1 - fresnelReflectance(1, outside, eta, inside)) * outside / inside *
           std::max(left, kWeak) *
           Physics<double>::henyeyGreenstein(-dot(collision.direction, arrival.direction), medium_.g);
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

// Of a light that shines from the same directions everywhere.
std::optional<Box> FacetBeams::directionsTo(std::uint32_t light) const {
    if (lights_.narrow(light)) {
        Box box{spans_[light][0], spans_[light][0]};
        for (const Vec3& wi : spans_[light]) box.hold(wi);
        const Vec3 between = (kBetween - 1) * length(box.high - box.low) * Vec3{1, 1, 1};
        return Box{box.low - between, box.high + between};
    }
    const LightSample sample = lights_.sampleOf(light, {}, 0.5, 0.5);
    if (!lights_.singular(light) || std::isfinite(sample.distance)) return {};
    return Box{sample.wi, sample.wi};
}

}  // namespace searchlight
