// Boxes behind each other, and what is seen of the foremost: what tests of light from behind share.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "geometry/rays.h"
#include "render/screen/back_light.h"

namespace searchlight::test {

// A box of 40 x 40 mm between these heights, without normals of vertices.
inline void addBox(Mesh& mesh, float low, float high) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const float z : {low, high})
        for (const auto& [x, y] : {std::pair{-20.0f, -20.0f}, {20.0f, -20.0f}, {20.0f, 20.0f}, {-20.0f, 20.0f}})
            mesh.positions.push_back({x, y, z});
    for (const auto& [a, b, c, d] : {std::array{4u, 5u, 6u, 7u},
                                     {3u, 2u, 1u, 0u},
                                     {0u, 1u, 5u, 4u},
                                     {1u, 2u, 6u, 5u},
                                     {2u, 3u, 7u, 6u},
                                     {3u, 0u, 4u, 7u}}) {
        mesh.triangles.push_back({first + a, first + b, first + c});
        mesh.triangles.push_back({first + a, first + c, first + d});
    }
}

/// Boxes from low to high.
inline Mesh boxes(const std::vector<std::pair<float, float>>& walls) {
    Mesh mesh;
    for (const auto& [low, high] : walls) addBox(mesh, low, high);
    return mesh;
}

inline Profile exponentialProfile() {
    std::vector<double> radii;
    std::vector<Rgb> values;
    for (int i = 0; i <= 600; ++i) {
        radii.push_back(0.001 * std::pow(3e4, i / 600.0));
        values.push_back({std::exp(-radii.back()), std::exp(-2 * radii.back()), 0});
    }
    return {radii, values};
}

// What the camera sees of the topmost face, in its middle.
struct BackLightCase {
    Object object{.longest_mm = 40};
    Scene scene;
    VisibleSurface visible{.width = 100, .height = 100, .eye = {0, 0, 100}};
    Profile profile = exponentialProfile();

    explicit BackLightCase(Mesh mesh, float top) {
        object.half_extent = {20, 20, 20};
        object.mesh = std::move(mesh);
        visible.positions = {{0.3f, 0.2f, top}};
        visible.normals = visible.geometric_normals = {{0, 0, 1}};
    }
    Rgb light(Thickness thickness, Light from) {
        Observer observer;
        scene.lights = {std::move(from)};
        return toDouble(backLight(visible, scene, object, RayScene(object.mesh), profile,
                                  {.thickness = thickness, .eta = 1.3, .threads = 1}, observer)[0]);
    }
    Rgb through(double way) const { return profile.total() - profile.encircled(way); }
};

}  // namespace searchlight::test
