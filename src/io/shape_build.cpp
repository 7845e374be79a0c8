// What all readers do with what they have read: triangles from polygons, unit normals, areas from radii.
#include <algorithm>
#include <array>
#include <numbers>

#include "io/shape_formats.h"

namespace searchlight {

namespace {

struct Point2 {
    double x = 0, y = 0;
};

double turn(Point2 a, Point2 b, Point2 c) { return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x); }

// Newell's normal: twice the area, also of polygons that are not quite plane.
Vec3 polygonNormal(const std::vector<Vec3f>& positions, std::span<const std::uint32_t> corners) {
    Vec3 normal;
    const Vec3 origin = toDouble(positions[corners[0]]);
    for (std::size_t i = 1; i + 1 < corners.size(); ++i)
        normal = normal + cross(toDouble(positions[corners[i]]) - origin, toDouble(positions[corners[i + 1]]) - origin);
    return normal;
}

// The polygon seen along the axis on which its normal is longest, counter-clockwise.
std::vector<Point2> flattened(const std::vector<Vec3f>& positions, std::span<const std::uint32_t> corners) {
    const Vec3 n = polygonNormal(positions, corners);
    const double x = std::abs(n.x), y = std::abs(n.y), z = std::abs(n.z);
    std::vector<Point2> flat;
    flat.reserve(corners.size());
    for (const std::uint32_t corner : corners) {
        const Vec3 p = toDouble(positions[corner]);
        if (z >= x && z >= y)
            flat.push_back(n.z > 0 ? Point2{p.x, p.y} : Point2{p.y, p.x});
        else if (y >= x)
            flat.push_back(n.y > 0 ? Point2{p.z, p.x} : Point2{p.x, p.z});
        else
            flat.push_back(n.x > 0 ? Point2{p.y, p.z} : Point2{p.z, p.y});
    }
    return flat;
}

// Cutting ears is quadratic; beyond this many corners a hostile file could stall.
constexpr std::size_t kMostEars = 128;

}  // namespace

void addPolygon(const std::vector<Vec3f>& positions, std::span<const std::uint32_t> corners,
                std::vector<std::array<std::uint32_t, 3>>& triangles) {
    const auto fan = [&](std::size_t first) {
        const std::size_t n = corners.size();
        for (std::size_t i = 1; i + 1 < n; ++i)
            triangles.push_back({corners[first], corners[(first + i) % n], corners[(first + i + 1) % n]});
    };
    if (corners.size() == 3 || corners.size() > kMostEars) return fan(0);
    const std::vector<Point2> flat = flattened(positions, corners);
    std::vector<std::size_t> rest(corners.size());
    for (std::size_t i = 0; i < rest.size(); ++i) rest[i] = i;
    const auto corner = [&](std::size_t i) { return flat[rest[i % rest.size()]]; };
    std::size_t reflex = 0, last_reflex = 0;
    for (std::size_t i = 0; i < rest.size(); ++i)
        if (turn(corner(i + rest.size() - 1), corner(i), corner(i + 1)) < 0) {
            ++reflex;
            last_reflex = i;
        }
    // A fan from the only inward corner is right for any quad, and convex polygons need no ears.
    if (reflex == 0 || corners.size() == 4) return fan(last_reflex);
    while (rest.size() > 3) {
        const std::size_t n = rest.size();
        std::size_t ear = 0;
        for (std::size_t i = 0; i < n && ear == 0; ++i) {
            const Point2 a = corner(i + n - 1), b = corner(i), c = corner(i + 1);
            if (turn(a, b, c) <= 0) continue;
            bool empty = true;
            for (std::size_t k = 2; k + 1 < n && empty; ++k) {
                const Point2 p = corner(i + k);
                empty = !(turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0);
            }
            if (empty) ear = i + 1;
        }
        // A polygon that crosses itself may have no ear: any corner will do.
        const std::size_t cut = ear == 0 ? 0 : ear - 1;
        triangles.push_back({corners[rest[(cut + n - 1) % n]], corners[rest[cut]], corners[rest[(cut + 1) % n]]});
        rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(cut));
    }
    triangles.push_back({corners[rest[0]], corners[rest[1]], corners[rest[2]]});
}

namespace {

// False, and zero, for what has no direction.
bool makeUnit(Vec3f& normal) {
    const Vec3 exact = toDouble(normal);
    const double size = length(exact);
    if (!std::isfinite(size) || size == 0) {
        normal = {};
        return false;
    }
    // What is unit within rounding stays as it is, so that writing and reading changes nothing.
    if (std::abs(size - 1) > 1e-6) normal = toFloat((1 / size) * exact);
    return true;
}

}  // namespace

void finishNormals(Mesh& mesh) {
    std::vector<std::uint32_t> unknown;
    for (std::size_t i = 0; i < mesh.normals.size(); ++i)
        if (!makeUnit(mesh.normals[i])) unknown.push_back(static_cast<std::uint32_t>(i));
    if (unknown.size() == mesh.normals.size()) mesh.normals.clear();
    if (unknown.empty() || mesh.normals.empty()) return;
    std::vector<Vec3> sums(unknown.size());
    for (const std::array<std::uint32_t, 3>& triangle : mesh.triangles)
        for (const std::uint32_t vertex : triangle) {
            const auto found = std::lower_bound(unknown.begin(), unknown.end(), vertex);
            if (found == unknown.end() || *found != vertex) continue;
            Vec3& sum = sums[static_cast<std::size_t>(found - unknown.begin())];
            sum = sum + polygonNormal(mesh.positions, triangle);
        }
    for (std::size_t i = 0; i < unknown.size(); ++i) {
        const double size = length(sums[i]);
        mesh.normals[unknown[i]] = size > 0 && std::isfinite(size) ? toFloat((1 / size) * sums[i]) : Vec3f{0, 0, 1};
    }
}

void finishCloud(PointCloud& cloud) {
    bool known = false;
    for (Vec3f& normal : cloud.normals) known |= makeUnit(normal);
    if (!known) cloud.normals.clear();
    if (std::ranges::all_of(cloud.areas, [](float area) { return area == 0; })) cloud.areas.clear();
}

std::optional<AreaRule> areaRule(std::string_view name) {
    if (name == "area" || name == "_area") return AreaRule::area;
    if (name == "radius" || name == "radiusPP" || name == "pscale") return AreaRule::radius;
    if (name == "width") return AreaRule::diameter;
    return std::nullopt;
}

std::optional<float> areaOf(AreaRule rule, float value) {
    if (!(value >= 0)) return std::nullopt;
    const double radius = rule == AreaRule::diameter ? 0.5 * value : value;
    const auto area = static_cast<float>(rule == AreaRule::area ? value : std::numbers::pi * radius * radius);
    if (!std::isfinite(area)) return std::nullopt;
    return area;
}

}  // namespace searchlight
