// Sphere and slab: both are a box, swollen by a radius.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/objects/objects.h"

namespace searchlight {

namespace {

struct RoundedBox {
    Vec3 inner;         // half extent of the box
    double radius = 0;  // by which it is swollen
};

double coordinate(Vec3 v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

// Positions along one axis of a face, from -(inner + radius) to it, mirrored exactly, as edges of faces have to meet.
// Over the rounded parts they stand at equal angles seen from the edge of the inner box, so that the swollen triangles
// are even.
std::vector<double> ticks(double inner, double radius, double step) {
    constexpr double quarter = std::numbers::pi / 4;
    const int round = std::max(4, static_cast<int>(std::lround(radius * quarter / step)));
    const int flat = inner > 0 ? std::max(1, static_cast<int>(std::lround(2 * inner / step))) : 0;
    std::vector<double> result;
    for (int i = -round; i < 0; ++i)
        result.push_back(-inner - (i == -round ? radius : radius * std::tan(quarter * -i / round)));
    for (int i = 0; i <= flat; ++i) result.push_back(flat == 0 ? 0 : inner * (2 * i - flat) / flat);
    for (int i = 1; i <= round; ++i)
        result.push_back(inner + (i == round ? radius : radius * std::tan(quarter * i / round)));
    return result;
}

// How far along the surface each tick is, from 0 to 1: uvs without the stretch of the swelling.
std::vector<float> along(const std::vector<double>& at, double inner, double radius) {
    const auto arc = [&](double x) {
        const double beyond = std::max(0.0, std::abs(x) - inner);
        return std::copysign(std::min(std::abs(x), inner) + radius * std::atan(beyond / radius), x);
    };
    std::vector<float> result;
    for (const double x : at)
        result.push_back(static_cast<float>((arc(x) - arc(at.front())) / (arc(at.back()) - arc(at.front()))));
    return result;
}

struct Rectangle {
    float left = 0, bottom = 0, width = 1, height = 1;
};

// A face of the cube and the directions of its chart; signs make u x v point outward.
struct Face {
    int normal, normal_sign, u, u_sign, v, v_sign;
};

constexpr Face faces[] = {{2, 1, 0, 1, 1, 1},  {2, -1, 0, -1, 1, 1}, {0, 1, 2, -1, 1, 1},
                          {0, -1, 2, 1, 1, 1}, {1, 1, 0, 1, 2, -1},  {1, -1, 0, 1, 2, 1}};

void addFace(Mesh& mesh, const RoundedBox& box, const Face& face, const Rectangle& chart, double step) {
    const double inner_u = coordinate(box.inner, face.u), inner_v = coordinate(box.inner, face.v);
    const std::vector<double> us = ticks(inner_u, box.radius, step), vs = ticks(inner_v, box.radius, step);
    const std::vector<float> chart_u = along(us, inner_u, box.radius), chart_v = along(vs, inner_v, box.radius);
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (std::size_t j = 0; j < vs.size(); ++j)
        for (std::size_t i = 0; i < us.size(); ++i) {
            double at[3];
            at[face.normal] = face.normal_sign * (coordinate(box.inner, face.normal) + box.radius);
            at[face.u] = face.u_sign * us[i];
            at[face.v] = face.v_sign * vs[j];
            const Vec3 cube{at[0], at[1], at[2]};
            const Vec3 core{std::clamp(cube.x, -box.inner.x, box.inner.x),
                            std::clamp(cube.y, -box.inner.y, box.inner.y),
                            std::clamp(cube.z, -box.inner.z, box.inner.z)};
            const Vec3 normal = normalize(cube - core);
            mesh.positions.push_back(toFloat(core + box.radius * normal));
            mesh.normals.push_back(toFloat(normal));
            mesh.uvs.push_back({chart.left + chart.width * chart_u[i], chart.bottom + chart.height * chart_v[j]});
        }
    const auto columns = static_cast<std::uint32_t>(us.size()), rows = static_cast<std::uint32_t>(vs.size());
    for (std::uint32_t j = 0; j + 1 < rows; ++j)
        for (std::uint32_t i = 0; i + 1 < columns; ++i) {
            const std::uint32_t a = first + j * columns + i, b = a + 1, c = a + columns, d = c + 1;
            // Towards the corners of a face its cells lean: the shorter diagonal is the one across the lean.
            if ((2 * i < columns - 1) == (2 * j < rows - 1)) {
                mesh.triangles.push_back({a, b, c});
                mesh.triangles.push_back({b, d, c});
            } else {
                mesh.triangles.push_back({a, b, d});
                mesh.triangles.push_back({a, d, c});
            }
        }
}

// Between charts, in uv: half a percent is two texels of a small map.
constexpr float gap = 0.005f;

Mesh roundedBox(const RoundedBox& box, const Rectangle (&charts)[6], double step) {
    Mesh mesh;
    for (int i = 0; i < 6; ++i) {
        const Rectangle inside{charts[i].left + gap, charts[i].bottom + gap, charts[i].width - 2 * gap,
                               charts[i].height - 2 * gap};
        addFace(mesh, box, faces[i], inside, step);
    }
    return mesh;
}

}  // namespace

Mesh sphereObject(double resolution) {
    Rectangle charts[6];
    for (int i = 0; i < 6; ++i)
        charts[i] = {static_cast<float>(i % 3) / 3, static_cast<float>(i / 3) / 2, 1.0f / 3, 1.0f / 2};
    return roundedBox({{}, 0.5}, charts, 0.01 / resolution);
}

Mesh slabObject(double resolution) {
    // Two plates side by side, the four narrow sides above them.
    const Rectangle charts[6] = {{0, 0, 0.5f, 0.5f},       {0.5f, 0, 0.5f, 0.5f},    {0, 0.5f, 0.1f, 0.5f},
                                 {0.1f, 0.5f, 0.1f, 0.5f}, {0.2f, 0.5f, 0.5f, 0.1f}, {0.2f, 0.6f, 0.5f, 0.1f}};
    const double radius = 0.02;
    return roundedBox({{0.5 - radius, 0.5 - radius, 0.1 - radius}, radius}, charts, 0.01 / resolution);
}

}  // namespace searchlight
