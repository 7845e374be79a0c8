#include "transport/mesh/facet_beams.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "base/error.h"
#include "model/physics.h"
#include "transport/mesh/distance_bounds.h"
#include "transport/mesh/facet_geometry.h"
#include "transport/walk/fresnel.h"

namespace searchlight {

namespace {

constexpr double kMostDirectRefs = 1 << 28;  // 1 GiB
// What is mirrored is a small part of most bodies' light: it is asked for at one collision of so many.
constexpr double kImages = 4;
constexpr float kAnywhere = 1e30F;  // slack that leaves all to arrive()

// Light from a point above a plane comes to one below it, `away` to the side: how far to the side it crosses. The two
// sines of Snell's law are monotone in that, so that Newton's steps within a bracket end.
double offsetOfRefraction(double height, double depth, double away, double eta) {
    double low = 0, high = away, offset = away * eta * height / (eta * height + depth);
    for (int i = 0; i < 60 && high - low > 1e-10 * away; ++i) {
        const double rest = away - offset;
        const double outside = 1 / std::sqrt(offset * offset + height * height);
        const double inside = 1 / std::sqrt(rest * rest + depth * depth);
        const double excess = offset * outside - eta * rest * inside;
        (excess < 0 ? low : high) = offset;
        const double slope =
            height * height * outside * outside * outside + eta * depth * depth * inside * inside * inside;
        const double next = offset - excess / slope;
        if (std::abs(next - offset) <= 1e-10 * away) return std::clamp(next, low, high);
        offset = next > low && next < high ? next : 0.5 * (low + high);
    }
    return offset;
}

}  // namespace

FacetBeams::FacetBeams(const MeshBody& body, const BodyMedium& medium, const LightSampler& lights, int channel,
                       std::size_t most_orders)
    : body_(body),
      medium_(medium),
      lights_(lights),
      channel_(channel),
      cells_(body.mesh()),
      reach_mm_(kReach / medium.sigma_t) {
    const Mesh& mesh = body.mesh();
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) normals_.push_back(unitNormal(mesh, t));
    for (std::uint32_t light = 0; light < lights.count(); ++light)
        if (lights.singular(light)) addBeams(light);
    discs_begin_ = static_cast<std::uint32_t>(beams_.size());
    gates_.resize(discs_begin_);
    for (std::uint32_t light = 0; light < lights.count(); ++light)
        if (!lights.singular(light) && lights.narrow(light)) addDisc(light);
    const auto direct = static_cast<std::uint32_t>(beams_.size());
    std::vector<Sweep> sweeps;
    for (const Beam& beam : beams_) sweeps.push_back(sweepOf(beam));
    std::vector<float> nearest_mm(cells_.count(), std::numeric_limits<float>::infinity());
    const auto listed = [&](std::uint32_t first, std::uint32_t end) {
        std::optional<CellLists> lists = CellLists::of(
            cells_, first, end, [&](std::uint32_t i) { return sweeps[i]; }, kMostDirectRefs, nearest_mm);
        if (!lists) throw inputError("the light's beams through the mesh take more than 1 GiB", "a coarser mesh");
        return std::move(*lists);
    };
    direct_ = listed(0, discs_begin_);
    discs_ = listed(discs_begin_, direct);
    findClear(sweeps);
    for (const float nearest : nearest_mm)
        worth_.push_back(static_cast<float>(std::exp(-medium_.sigma_t * static_cast<double>(nearest))));
    if (!lights.singular()) return;  // what is mirrored of discs is met
    measureMirrored();
    addOrders(std::min(most_orders, kMostOrders));
}

void FacetBeams::addBeams(std::uint32_t light) {
    const Mesh& mesh = body_.mesh();
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto [a, b, c] = cornersOf(mesh, t);
        const Vec3 normal = unitNormal(mesh, t);
        const LightSample sample = lights_.sampleOf(light, a, 0.5, 0.5);
        const double cosine = dot(sample.wi, normal);
        if (!(cosine > 0)) continue;
        Beam beam;
        beam.triangle = t, beam.light = light, beam.parallel = !std::isfinite(sample.distance);
        // Where light from a point is mirrored at one corner, it may enter elsewhere.
        const double most = beam.parallel ? cosine : cosinesOf(beam).outside;
        if ((1 - most) * (1 + most) >= medium_.eta * medium_.eta) continue;
        beam.end = static_cast<float>(reach_mm_);
        if (setRows(beam, frameOf(beam))) beams_.push_back(beam);
    }
}

// False for a facet without area.
bool FacetBeams::setRows(Beam& beam, const Frame& frame) const {
    const double volume = dot(frame.side, cross(frame.other, frame.direction));
    if (volume == 0) return false;
    const Vec3 rows[]{cross(frame.other, frame.direction), cross(frame.direction, frame.side),
                      cross(frame.side, frame.other)};
    for (int i = 0; i < 3; ++i) {
        beam.rows[i] = toFloat((1 / volume) * rows[i]);
        beam.constants[i] = static_cast<float>(-dot(rows[i], frame.corner) / volume);
    }
    if (beam.parallel || beam.order > 0) return true;
    if (grazes(beam)) {
        beam.slack = kAnywhere;
        return true;
    }
    beam.slack = static_cast<float>(2 * turnOf(beam) * (length(rows[0]) + length(rows[1])) / std::abs(volume));
    return true;
}

// How much the direction at a point of the facet differs from the one in its middle.
double FacetBeams::turnOf(const Beam& beam) const {
    if (beam.parallel) return 0;
    if (grazes(beam)) return 2;
    const auto corners = cornersOf(body_.mesh(), beam.triangle);
    const Vec3 middle = directionAt(beam, (1 / 3.0) * (corners[0] + corners[1] + corners[2]));
    double turn = 0;
    for (const Vec3& corner : corners) turn = std::max(turn, length(directionAt(beam, corner) - middle));
    return turn + bendOf(beam);
}

// Light from a point comes to a facet most steeply where the facet is nearest to it, and least at a corner.
FacetBeams::Cosines FacetBeams::cosinesOf(const Beam& beam) const {
    const auto corners = cornersOf(body_.mesh(), beam.triangle);
    const auto& [a, b, c] = corners;
    const Vec3 normal = unitNormal(body_.mesh(), beam.triangle);
    const LightSample light = lights_.sampleOf(beam.light, a, 0.5, 0.5);
    const Vec3 source = a + light.distance * light.wi;
    Cosines cosines;
    cosines.outside =
        std::min(1.0, light.distance * dot(light.wi, normal) / std::sqrt(squaredDistance(source, a, b, c)));
    const double sine = std::sqrt((1 - cosines.outside) * (1 + cosines.outside)) / medium_.eta;
    cosines.most = std::sqrt(std::max(0.0, (1 - sine) * (1 + sine)));
    cosines.least = cosines.most;
    for (const Vec3& corner : corners) cosines.least = std::min(cosines.least, -dot(directionAt(beam, corner), normal));
    return cosines;
}

// Whether light from a point comes to some of the facet so near to total reflection, or under it, that refracted
// directions are no linear function of the place.
bool FacetBeams::grazes(const Beam& beam) const {
    if (beam.parallel || medium_.eta >= 1) return false;
    const Cosines cosines = cosinesOf(beam);
    return cosines.most > 1.5 * cosines.least;
}

// Between the corners of a facet refracted directions differ from a linear function of the place by less than the
// square of the angle that it spans for the light.
double FacetBeams::bendOf(const Beam& beam) const {
    if (beam.parallel) return 0;
    const auto [a, b, c] = cornersOf(body_.mesh(), beam.triangle);
    const double side = std::max({length(b - a), length(c - a), length(c - b)});
    double near = std::numeric_limits<double>::infinity();
    for (const Vec3& corner : {a, b, c}) near = std::min(near, lights_.sampleOf(beam.light, corner, 0.5, 0.5).distance);
    double bend = std::pow(side / near, 2);
    if (medium_.eta < 1) {
        const Cosines cosines = cosinesOf(beam);
        bend = std::max(bend, 2 * (cosines.most - cosines.least));
    }
    return std::min(2.0, bend);
}

Vec3 FacetBeams::directionAt(const Beam& beam, Vec3 place) const {
    const LightSample sample = lights_.sampleOf(beam.light, place, 0.5, 0.5);
    return refracted(sample.wi, unitNormal(body_.mesh(), beam.triangle), medium_.eta);
}

// Where on a beam's facet, or near it, light enters that comes to a position. False where none does. Not of a disc.
bool FacetBeams::arrive(const Beam& beam, Vec3 position, Arrival& arrival) const {
    const Vec3 a = cornersOf(body_.mesh(), beam.triangle)[0], normal = normals_[beam.triangle];
    const double depth = -dot(position - a, normal), eta = medium_.eta;
    if (!(depth > 0)) return false;
    LightSample light = lights_.sampleOf(beam.light, a, 0.5, 0.5);
    double spread = 1;
    if (beam.parallel) {
        if (!(dot(light.wi, normal) > 0)) return false;
        arrival.direction = refracted(light.wi, normal, eta);
        arrival.distance = depth / -dot(arrival.direction, normal);
        arrival.entry = position - arrival.distance * arrival.direction;
    } else {
        const Vec3 source = a + light.distance * light.wi;
        const double height = dot(source - a, normal);
        const Vec3 foot = source - height * normal, lateral = position + depth * normal - foot;
        const double away = length(lateral), offset = offsetOfRefraction(height, depth, away, eta);
        arrival.entry = foot + (away > 0 ? offset / away : 0.0) * lateral;
        arrival.distance = length(position - arrival.entry);
        arrival.direction = (1 / arrival.distance) * (position - arrival.entry);
    }
    light = lights_.sampleOf(beam.light, arrival.entry, 0.5, 0.5);
    arrival.wi = light.wi;
    arrival.light_distance = light.distance;
    const double outside = dot(light.wi, normal), inside = -dot(arrival.direction, normal);
    if (!(outside > 0 && inside > 0)) return false;
    if (!beam.parallel) {
        // How a pencil of rays widens behind a plane interface, within the plane of incidence and across it.
        const double ratio = arrival.distance / (eta * light.distance);
        spread = (1 + ratio) * (1 + ratio * outside * outside / (inside * inside));
    }
    arrival.irradiance = light.irradiance_over_pdf[channel_] * (1 - fresnelReflectance(1, outside, eta, inside)) *
                         outside / (inside * spread);
    return arrival.irradiance > 0;
}

double FacetBeams::scattered(Vec3f position, Vec3 direction, SplitMix64& random, std::uint64_t& rays) const {
    const std::size_t cell = cells_.at(position);
    const Collision collision{position, direction};
    double sum = 0;
    const auto asked = static_cast<double>(worth_[cell]);
    if (asked == 1 || random.uniform() < asked) {
        if (discs_.size() > 0) sum += fromDiscs(discs_.at(cell), collision, random, rays);
        if (direct_.size() > 0)
            for (const std::uint32_t i : direct_.at(cell))
                if (mayReach(beams_[i], position)) sum += by(i, collision, random, rays);
        sum /= asked;
    }
    if (orders_ > 0 && random.uniform() * kImages < 1)
        for (const std::uint32_t i : images_.at(cell))
            if (mayReach(beams_[i], position)) sum += kImages * by(i, collision, random, rays);
    return sum / (medium_.eta * medium_.eta);
}

bool FacetBeams::mayReach(const Beam& beam, Vec3f position) const {
    const auto number = [&](int row) {
        const Vec3f& r = beam.rows[row];
        return r.x * position.x + r.y * position.y + r.z * position.z + beam.constants[row];
    };
    const float u = number(0), v = number(1), t = number(2);
    const float margin = static_cast<float>(kFacetMargin) + beam.slack * std::abs(t);
    const auto within = [&](int i, float x) { return x >= beam.low[i] - margin && x <= beam.high[i] + margin; };
    return within(0, u) && within(1, v) && within(2, u + v) && (!beam.parallel || (t > beam.begin && t < beam.end));
}

// Whether a place in the plane of a beam's facet is on it.
bool FacetBeams::enters(const Beam& beam, Vec3 entry) const {
    const auto number = [&](int row) {
        return dot(toDouble(beam.rows[row]), entry) + static_cast<double>(beam.constants[row]);
    };
    const double u = number(0), v = number(1);
    return u >= 0 && v >= 0 && u + v <= 1;
}

// Whether something is between a collision and the place of a facet, in the beam's straight way to it, or between that
// and the light.
bool FacetBeams::hidden(std::uint32_t beam, Vec3f from, const Arrival& light, std::uint64_t& rays) const {
    const Clearance clear = beam < clearances_.size() ? clearances_[beam] : Clearance{};
    const std::uint32_t facet = beams_[beam].triangle;
    if (light.distance < static_cast<double>(clear.inside_mm)) {
        if (!enters(beams_[beam], light.entry)) return true;
    } else {
        const auto hit = body_.rays().intersect({from, toFloat(-1.0 * light.direction)});
        ++rays;
        if (!hit || hit->triangle != facet) return true;
    }
    if (clear.outside) return false;
    ++rays;
    return body_.occluded({light.entry, normals_[facet]}, light.wi, light.light_distance);
}

double FacetBeams::by(std::uint32_t index, const Collision& collision, SplitMix64& random, std::uint64_t& rays) const {
    const Beam& beam = beams_[index];
    Vec3 place = toDouble(collision.position);
    const auto mirrors = mirrorsOf(beam);
    for (std::size_t i = mirrors.size(); i-- > 0;) place = imageOf(body_.mesh(), mirrors[i], place);
    Arrival light;
    if (!arrive(beam, place, light) || light.distance >= static_cast<double>(beam.end)) return 0;
    std::array<Leg, kMostOrders + 1> legs;
    const double left = throughMirrors(beam, light, legs) * std::exp(-medium_.sigma_t * light.distance);
    if (left == 0 || (left < kWeak && random.uniform() * kWeak >= left)) return 0;
    // Back along its legs.
    Vec3f from = collision.position;
    for (std::size_t leg = mirrors.size(); leg > 0; --leg) {
        const auto hit = body_.rays().intersect({from, toFloat(-1.0 * legs[leg].direction)});
        ++rays;
        if (!hit || hit->triangle != mirrors[leg - 1]) return 0;
        from = body_.below({legs[leg - 1].end, toDouble(hit->normal)});
    }
    if (hidden(index, from, light, rays)) return 0;
    // Along the light's way back: the collision's direction is that of the walk from the camera.
    return light.irradiance * std::max(left, kWeak) *
           Physics<double>::henyeyGreenstein(-dot(collision.direction, legs[mirrors.size()].direction), medium_.g);
}

}  // namespace searchlight
