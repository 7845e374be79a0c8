// Closed meshes with known volume and area.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <map>
#include <numbers>
#include <string>
#include <utility>

#include "scene/mesh.h"
#include "transport/mesh/reference_body.h"

namespace searchlight {

/// A box about the origin, two triangles a side.
inline Mesh boxMesh(Vec3 half) {
    Mesh mesh;
    for (int i = 0; i < 8; ++i)
        mesh.positions.push_back(
            toFloat(Vec3{i & 1 ? half.x : -half.x, i & 2 ? half.y : -half.y, i & 4 ? half.z : -half.z}));
    mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                      {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    return mesh;
}

/// An octahedron whose triangles are split four ways `times` times, on a sphere about the origin.
inline Mesh sphereMesh(double radius, int times) {
    std::vector<Vec3> points{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    std::vector<std::array<std::uint32_t, 3>> triangles{{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                                                        {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
    for (int i = 0; i < times; ++i) {
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
        const auto middle = [&](std::uint32_t a, std::uint32_t b) {
            const auto [at, added] = middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(points.size()));
            if (added) points.push_back(normalize(points[a] + points[b]));
            return at->second;
        };
        std::vector<std::array<std::uint32_t, 3>> split;
        for (const auto& [a, b, c] : triangles) {
            const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
            split.insert(split.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
        }
        triangles = std::move(split);
    }
    Mesh mesh;
    for (const Vec3 p : points) mesh.positions.push_back(toFloat(radius * p));
    mesh.triangles = std::move(triangles);
    return mesh;
}

/// Flux that uniform radiance carries across a surface, per flux that it carries to it: the integral of 2 mu T(mu).
inline double diffuseTransmittance(double eta) {
    if (eta == 1) return 1;
    constexpr int points = 100'000;
    double sum = 0;
    for (int i = 0; i < points; ++i) {
        const double mu = (i + 0.5) / points, t2 = 1 - (1 - mu * mu) / (eta * eta);
        if (t2 <= 0) continue;
        const double t = std::sqrt(t2), s = (mu - eta * t) / (mu + eta * t), p = (eta * mu - t) / (eta * mu + t);
        sum += 2 * mu * (1 - 0.5 * (s * s + p * p)) / points;
    }
    return sum;
}

/// Of one channel, coefficients in 1/mm.
inline Medium channelMedium(double sigma_a, double sigma_s, double g = 0, double eta = 1) {
    return makeMedium({sigma_a}, {sigma_s}, {g}, eta);
}

inline std::string dataMesh(const std::string& name) { return SEARCHLIGHT_SOURCE_DIR "/../shared/data/meshes/" + name; }

}  // namespace searchlight
