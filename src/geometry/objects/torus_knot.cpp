#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/objects/objects.h"

namespace searchlight {

namespace {

constexpr double turn = 2 * std::numbers::pi;

// The trefoil: twice around the axis, three times around the ring.
Vec3 knot(double t) {
    const double ring = 1 + 0.45 * std::cos(3 * t);
    return {ring * std::cos(2 * t), ring * std::sin(2 * t), 0.45 * std::sin(3 * t)};
}

Vec3 derivative(double t) {
    constexpr double h = 1e-4;
    return (1 / (2 * h)) * (knot(t + h) - knot(t - h));
}

struct Frame {
    Vec3 centre, side, up;
};

// Across the tube. The plane through the axis of the knot and the tangent gives a frame that closes without a twist of
// its own.
Frame frameAt(double t) {
    const Vec3 centre = knot(t), tangent = normalize(derivative(t));
    const Vec3 outward{std::cos(2 * t) * std::cos(3 * t), std::sin(2 * t) * std::cos(3 * t), std::sin(3 * t)};
    const Vec3 side = normalize(outward - dot(outward, tangent) * tangent);
    return {centre, side, cross(tangent, side)};
}

}  // namespace

Mesh torusKnotObject(double resolution) {
    constexpr double tube = 0.24;  // of the knot's ring, whose radius is 1
    const int around = std::max(8, static_cast<int>(std::lround(64 * resolution)));
    const int along = std::max(32, static_cast<int>(std::lround(720 * resolution)));
    Mesh mesh;
    // Its longest side becomes about 1.
    constexpr double scale = 1 / 3.3;
    for (int i = 0; i <= along; ++i)
        for (int j = 0; j <= around; ++j) {
            // The last row and column repeat the first ones exactly, with other uvs.
            const Frame frame = frameAt(turn * (i % along) / along);
            const double angle = turn * (j % around) / around;
            const Vec3 normal = std::cos(angle) * frame.side + std::sin(angle) * frame.up;
            mesh.positions.push_back(toFloat(scale * (frame.centre + tube * normal)));
            mesh.normals.push_back(toFloat(normal));
            mesh.uvs.push_back({static_cast<float>(i) / static_cast<float>(along),
                                1 - static_cast<float>(j) / static_cast<float>(around)});
        }
    const auto columns = static_cast<std::uint32_t>(around) + 1;
    for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(along); ++i)
        for (std::uint32_t j = 0; j + 1 < columns; ++j) {
            const std::uint32_t a = i * columns + j, b = a + columns, c = a + 1, d = b + 1;
            mesh.triangles.push_back({a, c, b});
            mesh.triangles.push_back({b, c, d});
        }
    return mesh;
}

}  // namespace searchlight
