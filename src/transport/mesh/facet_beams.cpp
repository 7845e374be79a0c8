#include "transport/mesh/facet_beams.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "model/physics.h"
#include "transport/mesh/entry.h"
#include "transport/walk/fresnel.h"

namespace searchlight {

namespace {

constexpr double kFewestCells = 8, kMostCells = 128;  // along the mesh: facets about as large as cells
constexpr double kMostRefs = 1 << 28;                 // 1 GiB
// Beams weaker than this are followed up by a roulette: they cost as many rays as the others.
constexpr double kWeak = 0.2;
constexpr double kMargin = 1e-3;  // of a facet: what float loses; the ray decides

// Towards the inside, for light from wi above a surface.
Vec3 refracted(Vec3 wi, Vec3 normal, double eta) {
    const double c = dot(wi, normal), t = std::sqrt(std::max(0.0, 1 - (1 - c) * (1 + c) / (eta * eta)));
    return normalize((-1 / eta) * wi + (c / eta - t) * normal);
}

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

// Between the corners of a facet refracted directions differ from a linear function of the place by less than the
// square of the angle that it spans for the light.
double bendOf(double side, double distance) { return std::min(2.0, std::pow(side / distance, 2)); }

struct Box {
    Vec3 low, high;

    void hold(Vec3 p) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
};

std::array<Vec3, 3> cornersOf(const Mesh& mesh, std::uint32_t triangle) {
    const auto& [a, b, c] = mesh.triangles[triangle];
    return {toDouble(mesh.positions[a]), toDouble(mesh.positions[b]), toDouble(mesh.positions[c])};
}

}  // namespace

FacetBeams::FacetBeams(const MeshBody& body, const BodyMedium& medium, const LightSampler& lights, int channel)
    : body_(body), medium_(medium), lights_(lights), channel_(channel), reach_mm_(kReach / medium.sigma_t) {
    for (std::uint32_t light = 0; light < lights.count(); ++light)
        if (lights.singular(light)) addBeams(light);
    fillCells();
    mirrored_ = measureMirrored();
}

void FacetBeams::addBeams(std::uint32_t light) {
    const Mesh& mesh = body_.mesh();
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto [a, b, c] = cornersOf(mesh, t);
        const Vec3 normal = unitNormal(mesh, t);
        const LightSample sample = lights_.sampleOf(light, a, 0.5, 0.5);
        const double cosine = dot(sample.wi, normal);
        if (!(cosine > 0) || (1 - cosine) * (1 + cosine) >= medium_.eta * medium_.eta) continue;
        Beam beam{t, light, !std::isfinite(sample.distance), 0, {}, {}};
        const LightSample middle = lights_.sampleOf(light, (1 / 3.0) * (a + b + c), 0.5, 0.5);
        const Vec3 d = refracted(middle.wi, normal, medium_.eta), side = b - a, other = c - a;
        const double volume = dot(side, cross(other, d));
        if (volume == 0) continue;  // a facet without area
        const Vec3 rows[]{cross(other, d), cross(d, side), cross(side, other)};
        for (int i = 0; i < 3; ++i) {
            beam.rows[i] = toFloat((1 / volume) * rows[i]);
            beam.constants[i] = static_cast<float>(-dot(rows[i], a) / volume);
        }
        if (!beam.parallel) {
            double turn = 0;
            for (const Vec3& corner : {a, b, c}) {
                const LightSample there = lights_.sampleOf(light, corner, 0.5, 0.5);
                turn = std::max(turn, length(refracted(there.wi, normal, medium_.eta) - d));
            }
            turn += bendOf(std::max(length(side), length(other)), middle.distance);
            beam.slack = static_cast<float>(2 * turn * (length(rows[0]) + length(rows[1])) / std::abs(volume));
        }
        beams_.push_back(beam);
    }
}

std::size_t FacetBeams::cellOf(Vec3f position) const {
    const auto along = [&](float p, double low, std::int32_t n) {
        return static_cast<std::size_t>(std::clamp((static_cast<double>(p) - low) / cell_mm_, 0.0, n - 1.0));
    };
    return (along(position.z, low_.z, nz_) * static_cast<std::size_t>(ny_) + along(position.y, low_.y, ny_)) *
               static_cast<std::size_t>(nx_) +
           along(position.x, low_.x, nx_);
}

// Visits at least the cells that a beam meets, each at least once, in slices of its length as long as a cell.
template <class Visit>
void FacetBeams::forEachCell(const Beam& beam, const Visit& visit) const {
    const Vec3 normal = unitNormal(body_.mesh(), beam.triangle);
    const auto corners = cornersOf(body_.mesh(), beam.triangle);
    Box facet{corners[0], corners[0]}, directions{};
    double bend = 0;
    for (int i = 0; i < 3; ++i) {
        const LightSample sample = lights_.sampleOf(beam.light, corners[i], 0.5, 0.5);
        const Vec3 d = refracted(sample.wi, normal, medium_.eta);
        if (i == 0) directions = {d, d};
        facet.hold(corners[i]);
        directions.hold(d);
        if (!beam.parallel) bend = std::max(bend, bendOf(length(facet.high - facet.low), sample.distance));
    }
    directions.low = directions.low - bend * Vec3{1, 1, 1}, directions.high = directions.high + bend * Vec3{1, 1, 1};
    const double margin = 1e-3 * cell_mm_;
    for (double from = 0; from < reach_mm_; from += cell_mm_) {
        const double to = std::min(from + cell_mm_, reach_mm_);
        const auto range = [&](double low, double high, double along_low, double along_high, double origin,
                               std::int32_t n) {
            const double first = low + std::min(from * along_low, to * along_low) - margin - origin;
            const double last = high + std::max(from * along_high, to * along_high) + margin - origin;
            return std::pair{static_cast<std::int32_t>(std::max(0.0, std::floor(first / cell_mm_))),
                             static_cast<std::int32_t>(std::min(n - 1.0, std::floor(last / cell_mm_)))};
        };
        const auto [x0, x1] = range(facet.low.x, facet.high.x, directions.low.x, directions.high.x, low_.x, nx_);
        const auto [y0, y1] = range(facet.low.y, facet.high.y, directions.low.y, directions.high.y, low_.y, ny_);
        const auto [z0, z1] = range(facet.low.z, facet.high.z, directions.low.z, directions.high.z, low_.z, nz_);
        if (x0 > x1 || y0 > y1 || z0 > z1) return;  // beyond the mesh, and so is what follows
        for (std::int32_t z = z0; z <= z1; ++z)
            for (std::int32_t y = y0; y <= y1; ++y)
                for (std::int32_t x = x0; x <= x1; ++x)
                    visit((static_cast<std::size_t>(z) * static_cast<std::size_t>(ny_) + static_cast<std::size_t>(y)) *
                              static_cast<std::size_t>(nx_) +
                          static_cast<std::size_t>(x));
    }
}

void FacetBeams::fillCells() {
    const Mesh& mesh = body_.mesh();
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Box box{{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};
    for (const Vec3f& p : mesh.positions) box.hold(toDouble(p));
    const Vec3 extent = box.high - box.low;
    const double longest = std::max({extent.x, extent.y, extent.z});
    cell_mm_ =
        longest / std::clamp(std::sqrt(static_cast<double>(mesh.triangles.size()) / 6), kFewestCells, kMostCells);
    low_ = box.low;
    const auto cells = [&](double side) { return static_cast<std::int32_t>(side / cell_mm_) + 1; };
    nx_ = cells(extent.x), ny_ = cells(extent.y), nz_ = cells(extent.z);
    const std::size_t count =
        static_cast<std::size_t>(nx_) * static_cast<std::size_t>(ny_) * static_cast<std::size_t>(nz_);

    // A beam that meets a cell in two slices is listed there once.
    std::vector<std::uint32_t> last(count, 0);
    std::vector<std::size_t> sizes(count, 0);
    double total = 0;
    const auto once = [&](const auto& add) {
        std::ranges::fill(last, 0);
        for (std::uint32_t i = 0; i < beams_.size(); ++i)
            forEachCell(beams_[i], [&](std::size_t cell) {
                if (last[cell] == i + 1) return;
                last[cell] = i + 1;
                add(cell, i);
            });
    };
    once([&](std::size_t cell, std::uint32_t) { ++sizes[cell], ++total; });
    if (total > kMostRefs)
        throw inputError("the light's beams through the mesh take more than 1 GiB", "a coarser mesh");
    first_.assign(count + 1, 0);
    for (std::size_t cell = 0; cell < count; ++cell)
        first_[cell + 1] = first_[cell] + static_cast<std::uint32_t>(sizes[cell]);
    list_.resize(first_.back());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    once([&](std::size_t cell, std::uint32_t beam) { list_[next[cell]++] = beam; });
}

// Where on a beam's facet, or near it, light enters that comes to a position. False where none does.
bool FacetBeams::arrive(const Beam& beam, Vec3 position, Arrival& arrival) const {
    const auto [a, b, c] = cornersOf(body_.mesh(), beam.triangle);
    const Vec3 normal = unitNormal(body_.mesh(), beam.triangle);
    const double depth = -dot(position - a, normal), eta = medium_.eta;
    if (!(depth > 0)) return false;
    LightSample light = lights_.sampleOf(beam.light, a, 0.5, 0.5);
    double spread = 1;
    if (beam.parallel) {
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
    const std::size_t cell = cellOf(position);
    double sum = 0;
    for (std::uint32_t i = first_[cell]; i < first_[cell + 1]; ++i) {
        const Beam& beam = beams_[list_[i]];
        const auto number = [&](int row) {
            const Vec3f& r = beam.rows[row];
            return r.x * position.x + r.y * position.y + r.z * position.z + beam.constants[row];
        };
        const float u = number(0), v = number(1), t = number(2);
        const float margin = static_cast<float>(kMargin) + beam.slack * std::abs(t);
        if (u < -margin || v < -margin || u + v > 1 + margin) continue;
        if (beam.parallel && !(t > 0 && static_cast<double>(t) < reach_mm_)) continue;
        Arrival light;
        if (!arrive(beam, toDouble(position), light) || light.distance >= reach_mm_) continue;
        double value = light.irradiance;
        const double left = std::exp(-medium_.sigma_t * light.distance);
        if (left < kWeak && random.uniform() * kWeak >= left) continue;
        value *= std::max(left, kWeak);
        const auto hit = body_.rays().intersect({position, toFloat(-1.0 * light.direction)});
        ++rays;
        if (!hit || hit->triangle != beam.triangle) continue;
        ++rays;
        if (body_.occluded({light.entry, toDouble(hit->normal)}, light.wi, light.light_distance)) continue;
        // Along the light's way back: `direction` is that of the walk from the camera.
        sum += value * Physics<double>::henyeyGreenstein(-dot(direction, light.direction), medium_.g);
    }
    return sum / (medium_.eta * medium_.eta);
}

double FacetBeams::measureMirrored() const {
    constexpr std::uint64_t candidates = 8192;  // knows the part to a few percent of itself
    const Illumination light = &lights_;
    // No candidate meets the roulette.
    EntrySource<MeshBody> source(body_, light, {channel_, medium_.eta, 1e-9 * body_.area()}, candidates, SplitMix64(1));
    double all = 0, mirrored = 0;
    for (Entry entry; source.next(entry);) {
        const double weight = static_cast<double>(entry.weight);
        all += weight;
        const auto hit = body_.rays().intersect({entry.position, entry.direction});
        if (!hit) continue;
        const double cosine = dot(toDouble(entry.direction), toDouble(hit->normal));
        if (cosine > 0)
            mirrored += weight * std::exp(-medium_.sigma_t * static_cast<double>(hit->t)) *
                        internalReflectance(medium_.eta, std::min(cosine, 1.0));
    }
    return all > 0 ? mirrored / all : 0;
}

}  // namespace searchlight
