// A chart laid flat: least squares conformal first, then as rigid as possible.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/vec.h"
#include "geometry/atlas/chart_growth.h"

namespace searchlight {

struct Vec2 {
    double x = 0, y = 0;
};
inline Vec2 operator+(Vec2 a, Vec2 b) { return {a.x + b.x, a.y + b.y}; }
inline Vec2 operator-(Vec2 a, Vec2 b) { return {a.x - b.x, a.y - b.y}; }
inline Vec2 operator*(double s, Vec2 a) { return {s * a.x, s * a.y}; }
inline double cross(Vec2 a, Vec2 b) { return a.x * b.y - a.y * b.x; }
inline double dot(Vec2 a, Vec2 b) { return a.x * b.x + a.y * b.y; }

/// A chart with vertices of its own.
struct ChartMesh {
    std::vector<Vec3> positions;
    std::vector<std::array<std::uint32_t, 3>> triangles;

    ChartMesh(const SurfaceGraph& surface, std::span<const std::uint32_t> faces);
};

/// One place in the plane per vertex, in the mesh's unit, the areas of both being equal. Free border: the conformal map
/// of [Levy2002], from which `rounds` local and global steps of [Liu2008, ARAP] lead to the most isometric one. Nothing
/// promises that it is one to one: areChartsSound() and overlaps() tell. The chart is a disc.
std::vector<Vec2> flatten(const ChartMesh& chart, int rounds = 12);

/// Conformal alone: keeps angles and no areas.
std::vector<Vec2> flattenConformally(const ChartMesh& chart);

}  // namespace searchlight
