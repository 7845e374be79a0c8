#include "geometry/atlas/texel_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>

#include "geometry/edges.h"

namespace searchlight {

namespace {

// A triangle cut to a texel: at most three corners and one more for each side of the square.
struct Polygon {
    std::array<Vec2, 8> corner;
    std::size_t count = 0;
};

// What lies on the low side of `limit` along an axis, or on the high side for sign -1 [Sutherland1974].
Polygon cut(const Polygon& from, bool along_y, double sign, double limit) {
    Polygon to;
    const auto outside = [&](Vec2 p) { return sign * ((along_y ? p.y : p.x) - limit); };
    for (std::size_t i = 0; i < from.count; ++i) {
        const Vec2 a = from.corner[i], b = from.corner[(i + 1) % from.count];
        const double at_a = outside(a), at_b = outside(b);
        if (at_a <= 0) to.corner[to.count++] = a;
        if ((at_a < 0 && at_b > 0) || (at_a > 0 && at_b < 0))
            to.corner[to.count++] = a + (at_a / (at_a - at_b)) * (b - a);
    }
    return to;
}

Polygon inTexel(const FlatTriangle& triangle, int x, int y) {
    Polygon polygon{{triangle[0], triangle[1], triangle[2]}, 3};
    polygon = cut(polygon, false, -1, x);
    polygon = cut(polygon, false, 1, x + 1);
    polygon = cut(polygon, true, -1, y);
    return cut(polygon, true, 1, y + 1);
}

double areaOf(const Polygon& polygon) {
    double twice = 0;
    for (std::size_t i = 2; i < polygon.count; ++i)
        twice += cross(polygon.corner[i - 1] - polygon.corner[0], polygon.corner[i] - polygon.corner[0]);
    return twice / 2;
}

Vec2 centroidOf(const Polygon& polygon) {
    Vec2 sum;
    double twice = 0;
    for (std::size_t i = 2; i < polygon.count; ++i) {
        const double part = cross(polygon.corner[i - 1] - polygon.corner[0], polygon.corner[i] - polygon.corner[0]);
        sum = sum + (part / 3) * (polygon.corner[0] + polygon.corner[i - 1] + polygon.corner[i]);
        twice += part;
    }
    return (1 / twice) * sum;
}

// Weights of the triangle's corners at a place in the plane.
std::array<double, 3> weightsAt(const FlatTriangle& triangle, Vec2 p) {
    const double twice = cross(triangle[1] - triangle[0], triangle[2] - triangle[0]);
    const double u = std::clamp(cross(p - triangle[0], triangle[2] - triangle[0]) / twice, 0.0, 1.0);
    const double v = std::clamp(cross(triangle[1] - triangle[0], p - triangle[0]) / twice, 0.0, 1 - u);
    return {1 - u - v, u, v};
}

Vec3 positionAt(const Mesh& mesh, std::uint32_t triangle, const std::array<double, 3>& weights) {
    Vec3 sum;
    for (std::size_t k = 0; k < 3; ++k) sum = sum + weights[k] * toDouble(mesh.positions[mesh.triangles[triangle][k]]);
    return sum;
}

Vec3f normalAt(const Mesh& mesh, std::uint32_t triangle, const std::array<double, 3>& weights) {
    Vec3 sum;
    for (std::size_t k = 0; k < 3; ++k) sum = sum + weights[k] * toDouble(mesh.normals[mesh.triangles[triangle][k]]);
    const double size = length(sum);
    return size > 1e-6 ? toFloat((1 / size) * sum) : mesh.normals[mesh.triangles[triangle][0]];
}

std::uint64_t spreadBits(std::uint32_t x) {
    std::uint64_t bits = x;
    bits = (bits | bits << 16) & 0x0000FFFF0000FFFFu;
    bits = (bits | bits << 8) & 0x00FF00FF00FF00FFu;
    bits = (bits | bits << 4) & 0x0F0F0F0F0F0F0F0Fu;
    bits = (bits | bits << 2) & 0x3333333333333333u;
    return (bits | bits << 1) & 0x5555555555555555u;
}

struct Found {
    std::uint64_t curve;  // place of the texel on the Z-order curve
    std::uint32_t chart, texel, triangle;
    double area;
    Vec3 centroid;
    Vec2 in_plane;
};

std::vector<Found> piecesOf(const Mesh& mesh, const Atlas& atlas) {
    std::vector<Found> pieces;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        if (atlas.charts[t] == no_triangle) continue;
        const FlatTriangle& flat = atlas.triangles[t];
        const double in_plane = cross(flat[1] - flat[0], flat[2] - flat[0]) / 2;
        const auto& [a, b, c] = mesh.triangles[t];
        const Vec3 origin = toDouble(mesh.positions[a]);
        const double on_surface =
            length(cross(toDouble(mesh.positions[b]) - origin, toDouble(mesh.positions[c]) - origin)) / 2;
        const auto [low_x, high_x] = std::minmax({flat[0].x, flat[1].x, flat[2].x});
        const auto [low_y, high_y] = std::minmax({flat[0].y, flat[1].y, flat[2].y});
        const auto texel = [&](double x) { return std::clamp(static_cast<int>(x), 0, atlas.resolution - 1); };
        for (int y = texel(low_y); y <= texel(high_y); ++y)
            for (int x = texel(low_x); x <= texel(high_x); ++x) {
                const Polygon polygon = inTexel(flat, x, y);
                const double area = areaOf(polygon);
                if (!(area > 0)) continue;
                const Vec2 centroid = centroidOf(polygon);
                pieces.push_back(
                    {spreadBits(static_cast<std::uint32_t>(x)) | spreadBits(static_cast<std::uint32_t>(y)) << 1,
                     atlas.charts[t], static_cast<std::uint32_t>(y * atlas.resolution + x), t,
                     area / in_plane * on_surface, positionAt(mesh, t, weightsAt(flat, centroid)), centroid});
            }
    }
    std::ranges::sort(pieces, {},
                      [](const Found& piece) { return std::tuple(piece.curve, piece.chart, piece.triangle); });
    return pieces;
}

}  // namespace

TexelMap mapTexels(const Mesh& mesh, const Atlas& atlas) {
    TexelMap map{.resolution = atlas.resolution};
    const std::vector<Found> pieces = piecesOf(mesh, atlas);
    for (std::size_t i = 0, end = 0; i < pieces.size(); i = end) {
        double area = 0;
        Vec3 middle;
        map.first_piece.push_back(static_cast<std::uint32_t>(map.pieces.size()));
        for (end = i;
             end < pieces.size() && pieces[end].texel == pieces[i].texel && pieces[end].chart == pieces[i].chart;
             ++end) {
            area += pieces[end].area;
            middle = middle + pieces[end].area * pieces[end].centroid;
            map.pieces.push_back({pieces[end].triangle, static_cast<float>(area)});
        }
        middle = (1 / area) * middle;
        // The centroid lies below a curved surface: the middle of the piece that is nearest to it is on it.
        const auto nearest = std::min_element(
            pieces.begin() + static_cast<std::ptrdiff_t>(i), pieces.begin() + static_cast<std::ptrdiff_t>(end),
            [&](const Found& a, const Found& b) { return length(a.centroid - middle) < length(b.centroid - middle); });
        map.cells.positions.push_back(toFloat(nearest->centroid));
        map.cells.normals.push_back(
            normalAt(mesh, nearest->triangle, weightsAt(atlas.triangles[nearest->triangle], nearest->in_plane)));
        map.cells.areas.push_back(static_cast<float>(area));
        map.texels.push_back(pieces[i].texel);
    }
    map.first_piece.push_back(static_cast<std::uint32_t>(map.pieces.size()));
    return map;
}

SurfaceSample sampleCell(const Mesh& mesh, const Atlas& atlas, const TexelMap& map, std::size_t cell, double u,
                         double v, double w) {
    const auto first = map.pieces.begin() + map.first_piece[cell],
               last = map.pieces.begin() + map.first_piece[cell + 1];
    const double wanted = u * static_cast<double>((last - 1)->until);
    const auto piece = std::min(std::ranges::upper_bound(first, last, wanted, {}, &TexelMap::Piece::until), last - 1);
    const FlatTriangle& flat = atlas.triangles[piece->triangle];
    const auto texel = static_cast<int>(map.texels[cell]);
    const Polygon polygon = inTexel(flat, texel % map.resolution, texel / map.resolution);
    // The fan of triangles about the first corner, one chosen by area; what is left of the number is used again.
    double left = v * areaOf(polygon);
    std::size_t i = 2;
    double part = 0;
    for (; i < polygon.count; ++i) {
        part = cross(polygon.corner[i - 1] - polygon.corner[0], polygon.corner[i] - polygon.corner[0]) / 2;
        if (left < part || i + 1 == polygon.count) break;
        left -= part;
    }
    const double along = part > 0 ? std::clamp(left / part, 0.0, 1.0) : 0.5, root = std::sqrt(along);
    const Vec2 p = polygon.corner[0] + root * ((1 - w) * (polygon.corner[i - 1] - polygon.corner[0]) +
                                               w * (polygon.corner[i] - polygon.corner[0]));
    const std::array<double, 3> weights = weightsAt(flat, p);
    return {toFloat(positionAt(mesh, piece->triangle, weights)), normalAt(mesh, piece->triangle, weights)};
}

}  // namespace searchlight
