#include "transport/mesh/near_triangles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "geometry/vertex_normals.h"
#include "transport/mesh/distance_bounds.h"
#include "transport/mesh/facet_geometry.h"

namespace searchlight {

NearTriangles::NearTriangles(const Mesh& mesh, double side) : mesh_(mesh), side_(side) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    low_ = {infinity, infinity, infinity};
    Vec3 high{-infinity, -infinity, -infinity};
    std::vector<Sphere> spheres;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const std::array at = corners(static_cast<std::uint32_t>(t));
        Sphere around{(1 / 3.0) * (at[0] + at[1] + at[2]), 0, static_cast<std::uint32_t>(t)};
        for (const Vec3& corner : at) around.radius = std::max(around.radius, length(corner - around.centre));
        spheres.push_back(around);
        normals_.push_back(triangleNormal(mesh, t));
        const Vec3 p = around.centre;
        low_ = {std::min(low_.x, p.x), std::min(low_.y, p.y), std::min(low_.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    const std::vector<Vec3f> at_corners = vertexNormals(mesh);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        Vec3 sum;
        for (const std::uint32_t v : mesh.triangles[t]) sum = sum + toDouble(at_corners[v]);
        smooth_normals_.push_back(length(sum) > 0 ? normalize(sum) : Vec3{0, 1, 0});
    }
    const Vec3 extent = high - low_;
    side_ = std::max(side_, std::max({extent.x, extent.y, extent.z}) / 200);
    const auto along = [this](double x) { return static_cast<int>(x / side_); };
    nx_ = along(extent.x) + 1, ny_ = along(extent.y) + 1, nz_ = along(extent.z) + 1;
    first_.assign(static_cast<std::size_t>(nx_) * ny_ * nz_ + 1, 0);
    for (const Sphere& sphere : spheres)
        if (sphere.radius > side_)
            large_.push_back(sphere);
        else
            ++first_[binOf(sphere) + 1], largest_ = std::max(largest_, sphere.radius);
    for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
    spheres_.resize(first_.back());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (const Sphere& sphere : spheres)
        if (sphere.radius <= side_) spheres_[next[binOf(sphere)]++] = sphere;
}

std::array<Vec3, 3> NearTriangles::corners(std::uint32_t triangle) const { return cornersOf(mesh_, triangle); }

int NearTriangles::clamped(double x, int n) const { return static_cast<int>(std::clamp(x / side_, 0.0, n - 1.0)); }

std::size_t NearTriangles::binOf(const Sphere& sphere) const {
    const Vec3 p = sphere.centre - low_;
    return (static_cast<std::size_t>(clamped(p.z, nz_)) * ny_ + clamped(p.y, ny_)) * nx_ + clamped(p.x, nx_);
}

void NearTriangles::find(Vec3 p, double radius, std::vector<Near>& found) const {
    found.clear();
    const auto test = [&](const Sphere& sphere) {
        const Vec3 away = sphere.centre - p;
        const double square = dot(away, away), reach = radius + sphere.radius;
        if (square >= reach * reach) return;
        double distance = std::sqrt(square) - sphere.radius;
        // A small triangle is as near as the sphere around it; of a large one that says little.
        if (sphere.radius > 0.1 * radius) {
            const auto [a, b, c] = corners(sphere.triangle);
            distance = std::sqrt(squaredDistance(p, a, b, c));
        }
        if (distance < radius) found.push_back({sphere.triangle, distance});
    };
    for (const Sphere& sphere : large_) test(sphere);
    const Vec3 at = p - low_;
    const double reach = radius + largest_;
    for (int z = clamped(at.z - reach, nz_); z <= clamped(at.z + reach, nz_); ++z)
        for (int y = clamped(at.y - reach, ny_); y <= clamped(at.y + reach, ny_); ++y) {
            const std::size_t row = (static_cast<std::size_t>(z) * ny_ + y) * nx_;
            const std::uint32_t end = first_[row + clamped(at.x + reach, nx_) + 1];
            for (std::uint32_t i = first_[row + clamped(at.x - reach, nx_)]; i < end; ++i) test(spheres_[i]);
        }
}

}  // namespace searchlight
