// Of single facets.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "scene/mesh.h"
#include "transport/mesh/surface_cells.h"

namespace searchlight {

/// Of a facet's sides: what single precision loses of places on it; rays decide.
constexpr double kFacetMargin = 1e-3;

/// Corners of a triangle, mm.
inline std::array<Vec3, 3> cornersOf(const Mesh& mesh, std::size_t triangle) {
    const auto& [a, b, c] = mesh.triangles[triangle];
    return {toDouble(mesh.positions[a]), toDouble(mesh.positions[b]), toDouble(mesh.positions[c])};
}

/// A direction (unit), or a difference of places, mirrored at a plane.
inline Vec3 reflected(Vec3 direction, Vec3 normal) { return direction - 2 * dot(direction, normal) * normal; }

/// A place mirrored at the plane of a triangle.
inline Vec3 imageOf(const Mesh& mesh, std::uint32_t triangle, Vec3 place) {
    const Vec3 corner = toDouble(mesh.positions[mesh.triangles[triangle][0]]);
    return corner + reflected(place - corner, unitNormal(mesh, triangle));
}

/// Towards the inside, for light from wi above a surface; all unit.
inline Vec3 refracted(Vec3 wi, Vec3 normal, double eta) {
    const double c = dot(wi, normal), t = std::sqrt(std::max(0.0, 1 - (1 - c) * (1 + c) / (eta * eta)));
    return normalize((-1 / eta) * wi + (c / eta - t) * normal);
}

}  // namespace searchlight
