#include "render/screen/back_light_gl.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "back_light_case.h"
#include "gl/context.h"

namespace searchlight {
namespace {

using test::BackLightCase;
using test::boxes;

constexpr Thickness all[] = {Thickness::nearest, Thickness::material, Thickness::outermost};

Rgb found(BackLightGl& device, BackLightCase& slab, Thickness thickness, Light from) {
    Observer observer;
    slab.scene.lights = {std::move(from)};
    return toDouble(device(slab.visible, slab.scene, slab.object, slab.profile,
                           {.thickness = thickness, .eta = 1.3, .threads = 1}, observer)[0]);
}

TEST(BackLightGl, GivesWhatRaysGiveThroughWallsBehindEachOther) {
    gl::Context context;
    BackLightGl device(context);
    const Light lights[] = {DirectionalLight{.direction = {0, 0, -1}}, DirectionalLight{.direction = {0.4, 0.1, -1}},
                            DirectionalLight{.direction = {0.1, 0, 1}},  // before the face: nothing shines through
                            PointLight{.position = {0.1, 0, -0.35}},     // near: a cube of maps
                            PointLight{.position = {0.5, 0, -3}}};
    for (const auto& walls : {std::vector<std::pair<float, float>>{{-10, -9.5f}, {0, 1.5f}},
                              {{-12, -11}, {-10, -9.5f}, {-3, -2}, {0, 1.5f}}}) {
        BackLightCase slab(boxes(walls), 1.5f);
        for (const Light& light : lights)
            for (const Thickness thickness : all) {
                const Rgb expected = slab.light(thickness, light), by_map = found(device, slab, thickness, light);
                // Lengths of single precision, of 20 mm.
                EXPECT_NEAR(by_map.r, expected.r, 1e-4 * expected.r);
                EXPECT_NEAR(by_map.g, expected.g, 1e-4 * expected.g);
            }
    }
}

TEST(BackLightGl, GapsAreNoMaterial) {
    // [Freude2014] Fig. 6.27: one shadow map takes both boxes and the gap for one thick object.
    gl::Context context;
    BackLightGl device(context);
    BackLightCase two(boxes({{-10, -9.5f}, {0, 1.5f}}), 1.5f);
    const DirectionalLight from_behind{.direction = {0, 0, -1}};
    const double thick = found(device, two, Thickness::outermost, from_behind).r;
    const double thin = found(device, two, Thickness::material, from_behind).r;
    EXPECT_NEAR(thin / thick, two.through(2).r / two.through(11.5).r, 1e-3 * thin / thick);
    EXPECT_EQ(found(device, two, Thickness::nearest, from_behind), (Rgb{}));  // its back lies in shadow
}

TEST(BackLightGl, IsThatOfRaysOnAKnotWhereTheMapHasNoOutline) {
    gl::Context context;
    BackLightGl device(context);
    Object object{.longest_mm = 40};
    object.mesh = builtInObject("torus_knot", -1);
    Vec3f low = object.mesh.positions[0], high = low;
    for (const Vec3f& p : object.mesh.positions) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    const float scale = 40 / std::max({high.x - low.x, high.y - low.y, high.z - low.z});
    for (Vec3f& p : object.mesh.positions)
        p = {scale * (p.x - 0.5f * (low.x + high.x)), scale * (p.y - 0.5f * (low.y + high.y)),
             scale * (p.z - 0.5f * (low.z + high.z))};
    object.half_extent = {20, 20, 20};
    const RayScene rays(object.mesh);
    const View view = makeView({.azimuth_deg = 20, .elevation_deg = 10}, object, 96, 96);
    Observer observer;
    const VisibleSurface visible = traceVisible(view, object, rays, {.edge_samples = 1, .threads = 1}, observer);
    Scene scene;
    scene.lights = {DirectionalLight{.direction = {-0.3, 0.2, -1}}};
    const Profile profile = test::exponentialProfile();
    for (const Thickness thickness : all) {
        const BackLightOptions options{.thickness = thickness, .eta = 1.3, .threads = 1};
        const auto expected = backLight(visible, scene, object, rays, profile, options, observer);
        const auto by_map = device(visible, scene, object, profile, options, observer);
        std::size_t lit = 0, other = 0;
        for (std::size_t i = 0; i < expected.size(); ++i) {
            lit += expected[i].r > 0 || by_map[i].r > 0;
            other += std::abs(by_map[i].r - expected[i].r) > 0.02f * std::max(expected[i].r, by_map[i].r) + 1e-6f;
        }
        EXPECT_GT(lit, 300u);
        // A texel is 0.03 mm, a fifteenth of the pixel: so many lines pass that close by an edge of a wall.
        EXPECT_LT(static_cast<double>(other), 0.03 * static_cast<double>(lit));
    }
}

}  // namespace
}  // namespace searchlight
