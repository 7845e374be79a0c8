// Positions and normals where rays hit, and where a picture has edges, on vector lanes.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "render/view.h"
#include "render/visible/tile_hits.h"

namespace searchlight {

/// Of hits, plane by plane; undefined where nothing is hit.
struct SurfacePlanes {
    std::array<std::vector<float>, 3> position, normal, geometric;

    void resize(std::size_t count);
    Vec3f positionAt(std::size_t i) const { return {position[0][i], position[1][i], position[2][i]}; }
    Vec3f normalAt(std::size_t i) const { return {normal[0][i], normal[1][i], normal[2][i]}; }
    Vec3f geometricAt(std::size_t i) const { return {geometric[0][i], geometric[1][i], geometric[2][i]}; }
};

/// Samples of one patch of the surface shade alike and lie near one plane.
struct PatchRule {
    /// Normals further apart than 25 degrees are a crease.
    static constexpr float crease_cosine = 0.9f;
    /// A neighbour on the same smooth surface lies within so many pixel widths of the tangent plane.
    static constexpr float depth_jump_pixels = 2;

    float largest_step;  ///< depth_jump_pixels times the width of a pixel at depth 1

    explicit PatchRule(const View& view)
        : largest_step(static_cast<float>(depth_jump_pixels * 2 * view.tan_half / view.height)) {}

    /// Whether `b` lies on the patch of `a`, the nearer of both being at 1 / inverse_depth.
    bool same(Vec3f normal_a, Vec3f geometric_a, Vec3f position_a, Vec3f normal_b, Vec3f position_b,
              float inverse_depth) const {
        const float turn = normal_a.x * normal_b.x + normal_a.y * normal_b.y + normal_a.z * normal_b.z;
        const float step = geometric_a.x * (position_b.x - position_a.x) +
                           geometric_a.y * (position_b.y - position_a.y) +
                           geometric_a.z * (position_b.z - position_a.z);
        return turn > crease_cosine && (step < 0 ? -step : step) * inverse_depth < largest_step;
    }
};

/// Fills the first `count` of `planes`, which have room for a vector more.
void surfaceAt(const Mesh& mesh, const View& view, const Hits& hits, std::size_t count, SurfacePlanes& planes);

/// Per row of the tile the pixels that have a neighbour in the picture on another patch, or beside the object.
void findEdges(const Tile& tile, const View& view, const Hits& hits, const SurfacePlanes& planes,
               std::array<std::uint64_t, Tile::side>& rows);

}  // namespace searchlight
