#include "transport/mesh/closed_body.h"

#include <fmt/format.h>

#include <hwy/cache_control.h>

#include <algorithm>
#include <cassert>
#include <chrono>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "base/error.h"
#include "base/text.h"
#include "geometry/edges.h"

namespace searchlight {

namespace {

// Side of a cell of the safe regions in mean free paths, within limits of the mesh's length: measured on marble and
// skin (docs/mesh-reference.md). Finer cells save rays and cost cache.
constexpr double kCellMfp = 1.3;
constexpr double kMostAlong = 256, kFewestAlong = 32;
// Regions reach no further than this part of the mesh, or each would be cut from most of its triangles.
constexpr double kReachAlong = 20;

// Single precision knows positions to 1e-3 mean free paths here.
constexpr double kLargestMfp = 1e4;

std::string faultOfEdges(const Mesh& mesh) {
    const Weld weld = weldPositions(mesh.positions);
    const std::vector<HalfEdge> edges = halfEdges(mesh, weld);
    std::size_t open = 0, crowded = 0, turned = 0;
    const HalfEdge* first = nullptr;
    for (std::size_t i = 0, end = 0; i < edges.size(); i = end) {
        while (end < edges.size() && edges[end].low == edges[i].low && edges[end].high == edges[i].high) ++end;
        const bool pair = end - i == 2, opposite = pair && edges[i].ascending != edges[i + 1].ascending;
        if (end - i == 1) ++open;
        if (end - i > 2) ++crowded;
        if (pair && !opposite) ++turned;
        if (!opposite && !first) first = &edges[i];
    }
    if (!first) return {};
    const auto corner = [&](std::size_t k) {
        const Vec3f p = mesh.positions[mesh.triangles[first->triangle][k % 3]];
        return fmt::format("({:.6g}, {:.6g}, {:.6g})", p.x, p.y, p.z);
    };
    std::string fault;
    const auto add = [&](std::size_t count, const char* what) {
        if (count > 0) fault += fmt::format("{}{} {}", fault.empty() ? "" : ", ", count, what);
    };
    add(open, "open edges");
    add(crowded, "edges of more than two triangles");
    add(turned, "edges between triangles of opposite orientation");
    return fmt::format("{}; the first from {} to {}, of triangle {}", fault, corner(first->side),
                       corner(first->side + std::size_t{1}), first->triangle);
}

// The same surface with triangles, and the vertices that they use, in the order of a Morton curve: what walks touch one
// after the other lies side by side.
Mesh alongCurve(const Mesh& mesh) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Vec3 low{infinity, infinity, infinity}, high{-infinity, -infinity, -infinity};
    std::vector<Vec3> middles;
    for (const auto& [a, b, c] : mesh.triangles) {
        const Vec3 p =
            (1 / 3.0) * (toDouble(mesh.positions[a]) + toDouble(mesh.positions[b]) + toDouble(mesh.positions[c]));
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
        middles.push_back(p);
    }
    constexpr int levels = 10;
    const double side = std::max({high.x - low.x, high.y - low.y, high.z - low.z}) * (1 + 1e-9);
    const auto spread = [&](double x) {
        const auto place = side > 0 ? static_cast<std::uint32_t>((1 << levels) * (x / side)) : 0;
        std::uint32_t bits = 0;
        for (int i = 0; i < levels; ++i) bits |= (place >> i & 1) << 3 * i;
        return bits;
    };
    std::vector<std::pair<std::uint32_t, std::uint32_t>> order;
    for (std::uint32_t t = 0; t < middles.size(); ++t) {
        const Vec3 p = middles[t] - low;
        order.push_back({spread(p.x) | spread(p.y) << 1 | spread(p.z) << 2, t});
    }
    std::ranges::sort(order);
    constexpr auto none = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> number(mesh.positions.size(), none);
    Mesh sorted;
    for (const auto& [key, t] : order) {
        auto triangle = mesh.triangles[t];
        for (std::uint32_t& v : triangle) {
            if (number[v] == none) {
                number[v] = static_cast<std::uint32_t>(sorted.positions.size());
                sorted.positions.push_back(mesh.positions[v]);
            }
            v = number[v];
        }
        sorted.triangles.push_back(triangle);
    }
    return sorted;
}

void put(const Crossing& crossing, FlightHits& hits, std::int32_t flight, std::size_t i) {
    hits.flight[i] = flight;
    hits.triangle[i] = static_cast<std::int32_t>(crossing.triangle);
    hits.u[i] = crossing.u, hits.v[i] = crossing.v;
    const Vec3f normal = toFloat(crossing.normal), at = crossing.position, inside = crossing.inside;
    hits.nx[i] = normal.x, hits.ny[i] = normal.y, hits.nz[i] = normal.z;
    hits.x[i] = at.x, hits.y[i] = at.y, hits.z[i] = at.z;
    hits.inside_x[i] = inside.x, hits.inside_y[i] = inside.y, hits.inside_z[i] = inside.z;
}

}  // namespace

void requireResolved(double longest_mm, double mfp_mm) {
    if (!(mfp_mm > 0 && longest_mm <= kLargestMfp * mfp_mm))
        throw inputError(fmt::format("the body is {:.3g} mean free paths long", longest_mm / mfp_mm),
                         "up to 1e4: beyond, single precision does not resolve them");
}

Ball::Ball(double radius_mm, double cell_area_mm2) : radius_(radius_mm) {
    if (!(radius_mm > 0 && radius_mm <= 1e9))
        throw inputError("the radius of a sphere is " + numberText(radius_mm), "above 0, up to 1e9 mm");
    const double surface = 4 * std::numbers::pi * radius_mm * radius_mm;
    cells_ = makeSphereCells(radius_mm, cell_area_mm2 > 0 ? cell_area_mm2 : surface / 32768);
}

double Ball::area() const { return 4 * std::numbers::pi * radius_ * radius_; }
double Ball::volume() const { return 4 * std::numbers::pi / 3 * radius_ * radius_ * radius_; }

SurfacePoint Ball::pointAt(double u, double v, double) const {
    const double y = 1 - 2 * u, ring = std::sqrt(std::max(0.0, 1 - y * y)), turn = 2 * std::numbers::pi * v;
    const Vec3 normal{ring * std::cos(turn), y, ring * std::sin(turn)};
    return {radius_ * normal, normal};
}

void Ball::cross(std::span<const Ray> flights, std::span<Crossing> crossings) const {
    for (std::size_t i = 0; i < flights.size(); ++i) {
        const Vec3 p = toDouble(flights[i].origin), d = toDouble(flights[i].direction);
        // A start that rounding has put outside crosses at once if it goes outwards; a sphere loses no flight.
        const double a = dot(d, d), b = dot(p, d), c = dot(p, p) - radius_ * radius_;
        Crossing& crossing = crossings[i];
        crossing = {};
        if (a == 0) continue;  // shorter than a rounding
        const double t = std::max(0.0, (-b + std::sqrt(std::max(0.0, b * b - a * c))) / a);
        if (t > static_cast<double>(flights[i].t_max)) continue;
        crossing.what = Crossing::What::surface;
        crossing.normal = normalize(p + t * d);
        crossing.position = crossing.inside = toFloat(radius_ * crossing.normal);
        crossing.cell = cellOf(crossing);
    }
}

void Ball::cross(const Flights& flights, FlightHits& hits) const {
    hits.count = hits.lost_count = 0;
    for (std::size_t i = 0; i < flights.count; ++i) {
        const Ray flight{
            {flights.x[i], flights.y[i], flights.z[i]}, {flights.dx[i], flights.dy[i], flights.dz[i]}, 0, 1};
        Crossing crossing;
        cross({&flight, 1}, {&crossing, 1});
        if (crossing.what == Crossing::What::surface) put(crossing, hits, static_cast<std::int32_t>(i), hits.count++);
    }
}

std::optional<SurfacePoint> Ball::seen(Vec3 origin, Vec3 direction) const {
    const double b = dot(origin, direction), c = dot(origin, origin) - radius_ * radius_;
    if (b * b <= c || b > 0) return {};
    const Vec3 normal = normalize(origin + (-b - std::sqrt(b * b - c)) * direction);
    return SurfacePoint{radius_ * normal, normal};
}

std::optional<double> Ball::wayOut(Vec3 position, Vec3 wi, double) const {
    const double b = dot(position, wi), c = dot(position, position) - radius_ * radius_;
    return std::max(0.0, -b + std::sqrt(std::max(0.0, b * b - c)));
}

double enclosedVolume(const Mesh& mesh) {
    double volume = 0;
    for (const auto& [a, b, c] : mesh.triangles)
        volume += dot(toDouble(mesh.positions[a]), cross(toDouble(mesh.positions[b]), toDouble(mesh.positions[c])));
    return volume / 6;
}

void checkClosed(const Mesh& mesh) {
    if (mesh.triangles.empty()) throw inputError("a mesh without triangles encloses nothing");
    if (const std::string fault = faultOfEdges(mesh); !fault.empty())
        throw inputError("the mesh encloses no volume: " + fault,
                         "a reference needs a closed mesh in which each edge joins two triangles");
    if (const double volume = enclosedVolume(mesh); !(volume > 0))
        throw inputError(fmt::format("the mesh is inside out: it encloses {:.4g} mm^3", volume),
                         "triangles run counter-clockwise seen from outside");
}

MeshBody::MeshBody(const Mesh& mesh, const MeshBodyOptions& options)
    : mesh_((checkClosed(mesh), alongCurve(mesh))), rays_(mesh_), cells_(mesh_, options.cell_area_mm2) {
    const auto begin = std::chrono::steady_clock::now();
    volume_ = enclosedVolume(mesh_);
    double area = 0;
    Vec3f low = mesh_.positions[mesh_.triangles[0][0]], high = low;
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
        area_to_.push_back(area += triangleArea(mesh_, t));
        for (const std::uint32_t v : mesh_.triangles[t]) {
            const Vec3f p = mesh_.positions[v];
            low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
            high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
        }
    }
    const Vec3 extent = toDouble(high) - toDouble(low);
    const double longest = std::max({extent.x, extent.y, extent.z});
    requireResolved(longest, options.shortest_mfp);
    for (std::size_t bucket = 0; bucket <= area_to_.size(); ++bucket) {
        const double target = area * static_cast<double>(bucket) / static_cast<double>(area_to_.size());
        const auto found = std::ranges::upper_bound(area_to_, target * (1 - 1e-12));
        first_.push_back(std::min(found - area_to_.begin(), std::ssize(area_to_) - 1));
    }
    // Coordinates are rounded to 2^-25 of the largest; three of them, and the rounding of barycentric coordinates.
    nudge_ = static_cast<double>(rays_.extent()) * 0x1p-22;
    const double cell = std::clamp(kCellMfp * options.shortest_mfp, longest / kMostAlong, longest / kFewestAlong);
    const double reach = std::min(options.shortest_mfp, longest / kReachAlong);
    regions_ = options.regions ? buildSafeRegions(mesh_, cell, reach, options.threads)
                               : unknownRegion(toDouble(low), toDouble(high));
    if ((options.regions || options.grid_alone) && mesh_.triangles.size() <= TriangleGrid::kMostTriangles)
        grid_ = buildTriangleGrid(mesh_, gridCell(mesh_, area, options.shortest_mfp));
    const auto end = [&](float origin, std::int32_t cells) {
        return origin + static_cast<float>(cells) * regions_.cell_mm;
    };
    low_ = regions_.origin;
    high_ = {end(low_.x, regions_.nx), end(low_.y, regions_.ny), end(low_.z, regions_.nz)};
    build_seconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

SurfacePoint MeshBody::pointAt(double u, double v, double w) const {
    const double target = u * area();
    const auto bucket =
        std::min(static_cast<std::size_t>(u * static_cast<double>(first_.size() - 1)), first_.size() - 2);
    const auto begin = area_to_.begin() + first_[bucket], end = area_to_.begin() + first_[bucket + 1];
    const auto t = static_cast<std::size_t>(std::upper_bound(begin, end, target) - area_to_.begin());
    const auto& [a, b, c] = mesh_.triangles[t];
    const Vec3 p = toDouble(mesh_.positions[a]);
    const double root = std::sqrt(v), along = root * w;
    return {p + (1 - root) * (toDouble(mesh_.positions[b]) - p) + along * (toDouble(mesh_.positions[c]) - p),
            unitNormal(mesh_, t)};
}

Vec3f MeshBody::below(const SurfacePoint& point) const { return toFloat(point.position - nudge_ * point.normal); }

bool MeshBody::occluded(const SurfacePoint& point, Vec3 wi, double distance) const {
    const float reach = static_cast<float>(distance);
    return rays_.occluded({toFloat(point.position + nudge_ * point.normal), toFloat(wi), 0, reach});
}

void MeshBody::occluded(std::span<const Shadow> shadows, std::span<std::uint8_t> hidden) const {
    std::vector<Ray> rays;
    rays.reserve(shadows.size());
    for (const auto& [point, wi, distance] : shadows)
        rays.push_back({toFloat(point.position + nudge_ * point.normal), toFloat(wi), 0, static_cast<float>(distance)});
    rays_.occluded(rays, hidden.first(rays.size()), true);
}

std::optional<SurfacePoint> MeshBody::seen(Vec3 origin, Vec3 direction) const {
    const auto hit = rays_.intersect({toFloat(origin), toFloat(direction)});
    if (!hit) return {};
    return SurfacePoint{positionOf(*hit), toDouble(hit->normal)};
}

std::optional<double> MeshBody::wayOut(Vec3 position, Vec3 wi, double distance) const {
    const auto hit = rays_.intersect({toFloat(position), toFloat(wi)});
    if (!hit) return 0.0;  // on the surface, by rounding
    const double out = static_cast<double>(hit->t);
    if (occluded({position + out * wi, toDouble(hit->normal)}, wi, distance - out)) return {};
    return out;
}

// A flight that starts on the surface may have been rounded to its far side and cross it inwards first: that crossing
// is none. Nothing is returned when the flight comes from farther outside.
std::optional<RayHit> MeshBody::leaving(const Ray& flight, const RayHit& entered) const {
    Ray rest = flight;
    RayHit hit = entered;
    for (int i = 0; i < 4; ++i) {
        const double cosine = dot(toDouble(flight.direction), toDouble(hit.normal));
        if (cosine > 0) return hit;
        if (-cosine * static_cast<double>(hit.t) > 2 * nudge_) return {};
        rest.t_min = std::nextafter(hit.t, rest.t_max);
        const std::optional<RayHit> next = rays_.intersect(rest);
        if (!next) return RayHit{std::numeric_limits<float>::infinity()};
        hit = *next;
    }
    return {};
}

void MeshBody::cross(std::span<const Ray> flights, std::span<Crossing> crossings) const {
    assert(flights.size() == crossings.size());
    constexpr std::size_t most = 64;
    RayHit hits[most];
    Vec3 positions[most];
    for (std::size_t first = 0; first < flights.size(); first += most) {
        const std::size_t count = std::min(most, flights.size() - first);
        const std::span<const Ray> some = flights.subspan(first, count);
        if (!grid_.blocks.empty()) {
            grid_.intersect(some, {hits, count}, {positions, count});
        } else {
            rays_.intersect(some, {hits, count}, false);
            for (std::size_t i = 0; i < count; ++i)
                if (std::isfinite(hits[i].t)) positions[i] = positionOf(hits[i]);
        }
        for (std::size_t i = 0; i < count; ++i) {
            Crossing& crossing = crossings[first + i];
            crossing.what = cross(flights[first + i], hits[i], positions[i], crossing);
            if (crossing.what == Crossing::What::surface) crossing.cell = cellOf(crossing);
        }
    }
}

void MeshBody::cross(const Flights& flights, FlightHits& hits) const {
    hits.lost_count = 0;
    if (!grid_.blocks.empty()) {
        grid_.intersect(flights, static_cast<float>(nudge_), hits);
    } else {
        ListedHit found[Flights::kMost];
        hits.count = rays_.intersect(
            {flights.x, flights.y, flights.z, flights.dx, flights.dy, flights.dz, flights.begin, flights.count, 1},
            found);
        for (const ListedHit& hit : std::span(found, hits.count)) hwy::Prefetch(&mesh_.triangles[hit.hit.triangle]);
        for (std::size_t i = 0; i < hits.count; ++i) {
            Crossing crossing;
            fill(found[i].hit, positionOf(found[i].hit), crossing);
            put(crossing, hits, static_cast<std::int32_t>(found[i].ray), i);
        }
    }
    // Nearly always all hits are from inside.
    std::size_t kept = 0;
    for (std::size_t i = 0; i < hits.count; ++i) {
        const auto at = static_cast<std::size_t>(hits.flight[i]);
        const Vec3f along{flights.dx[at], flights.dy[at], flights.dz[at]};
        if (along.x * hits.nx[i] + along.y * hits.ny[i] + along.z * hits.nz[i] > 0) {
            if (kept != i) hits.move(i, kept);
            ++kept;
            continue;
        }
        const Ray flight{{flights.x[at], flights.y[at], flights.z[at]}, along, flights.begin[at], 1};
        Crossing crossing;
        cross({&flight, 1}, {&crossing, 1});
        if (crossing.what == Crossing::What::lost) hits.lost[hits.lost_count++] = hits.flight[i];
        if (crossing.what == Crossing::What::surface) put(crossing, hits, hits.flight[i], kept++);
    }
    hits.count = kept;
}

bool MeshBody::beyond(Vec3f end) const {
    return !(end.x > low_.x && end.x < high_.x && end.y > low_.y && end.y < high_.y && end.z > low_.z &&
             end.z < high_.z);
}

Vec3 MeshBody::positionOf(const RayHit& hit) const {
    const auto& [a, b, c] = mesh_.triangles[hit.triangle];
    const Vec3 p = toDouble(mesh_.positions[a]);
    return p + static_cast<double>(hit.u) * (toDouble(mesh_.positions[b]) - p) +
           static_cast<double>(hit.v) * (toDouble(mesh_.positions[c]) - p);
}

void MeshBody::fill(const RayHit& hit, Vec3 at, Crossing& crossing) const {
    crossing.normal = toDouble(hit.normal);
    crossing.position = toFloat(at);
    crossing.inside = toFloat(at - nudge_ * crossing.normal);
    crossing.triangle = hit.triangle;
    crossing.u = hit.u, crossing.v = hit.v;
}

Crossing::What MeshBody::cross(const Ray& flight, RayHit hit, Vec3 at, Crossing& crossing) const {
    if (std::isfinite(hit.t) && !(dot(toDouble(flight.direction), toDouble(hit.normal)) > 0)) {
        const std::optional<RayHit> left = leaving(flight, hit);
        if (!left) return Crossing::What::lost;
        hit = *left;
        if (std::isfinite(hit.t)) at = positionOf(hit);
    }
    if (!std::isfinite(hit.t)) {
        const Vec3f from = flight.origin, along = flight.direction;
        const auto end = [&](float begin, float way) { return begin + flight.t_max * way; };
        return beyond({end(from.x, along.x), end(from.y, along.y), end(from.z, along.z)}) ? Crossing::What::lost
                                                                                          : Crossing::What::none;
    }
    fill(hit, at, crossing);
    return Crossing::What::surface;
}

}  // namespace searchlight
