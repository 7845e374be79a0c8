#include "render/screen/back_light.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "light/transmitted_cosine.h"

namespace searchlight {
namespace {

// A box of 40 x 40 mm between these heights, without normals of vertices.
void addBox(Mesh& mesh, float low, float high) {
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

Profile exponential() {
    std::vector<double> radii;
    std::vector<Rgb> values;
    for (int i = 0; i <= 600; ++i) {
        radii.push_back(0.001 * std::pow(3e4, i / 600.0));
        values.push_back({std::exp(-radii.back()), std::exp(-2 * radii.back()), 0});
    }
    return {radii, values};
}

// What the camera sees of the topmost face, in its middle.
struct Case {
    Object object{.longest_mm = 40};
    Scene scene;
    VisibleSurface visible{.width = 100, .height = 100, .eye = {0, 0, 100}};
    Profile profile = exponential();

    explicit Case(Mesh mesh, float top) {
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

constexpr Thickness all[] = {Thickness::nearest, Thickness::material, Thickness::outermost};
const DirectionalLight from_behind{.direction = {0, 0, -1}, .irradiance = {2, 2, 2}};

TEST(BackLight, ThroughASlabIsTheProfilesIntegralBeyondItsThickness) {
    Mesh mesh;
    addBox(mesh, 0, 1.5f);
    Case slab(mesh, 1.5f);
    // The integral of R_d((r^2 + s^2)^1/2) over the back: of exp(-r) it is 2 pi (1 + s) exp(-s).
    EXPECT_NEAR(slab.through(1.5).r, 2 * std::numbers::pi * 2.5 * std::exp(-1.5), 1e-4);
    for (const Thickness thickness : all) {
        const Rgb found = slab.light(thickness, from_behind);
        const Rgb expected = 2 * transmittedCosine(1, 1.3) * slab.through(1.5);
        EXPECT_NEAR(found.r, expected.r, 1e-4 * expected.r);  // rounding of the ray's way and of T12's table
        EXPECT_NEAR(found.g, expected.g, 1e-4 * expected.g);
        EXPECT_EQ(found.b, 0);
    }
    EXPECT_EQ(slab.light(Thickness::nothing, from_behind), (Rgb{}));
}

TEST(BackLight, ComesFromBehindOnly) {
    Mesh mesh;
    addBox(mesh, 0, 1.5f);
    Case slab(mesh, 1.5f);
    for (const Thickness thickness : all)
        EXPECT_EQ(slab.light(thickness, DirectionalLight{.direction = {0.1, 0, 1}}), (Rgb{}));
}

TEST(BackLight, SlantedLightGoesItsOwnWay) {
    Mesh mesh;
    addBox(mesh, 0, 1.5f);
    Case slab(mesh, 1.5f);
    const double cosine = std::sqrt(0.5);
    const Rgb found = slab.light(Thickness::nearest, DirectionalLight{.direction = {1, 0, -1}});
    const double expected = transmittedCosine(cosine, 1.3) * slab.through(1.5 / cosine).r;
    EXPECT_NEAR(found.r, expected, 1e-4 * expected);
}

TEST(BackLight, APointIsBrighterWhereItIsNear) {
    Mesh mesh;
    addBox(mesh, 0, 1.5f);
    Case slab(mesh, 1.5f);
    slab.visible.positions = {{0, 0, 1.5f}};
    // Half a longest side, 20 mm, behind the object's centre: four times the light of one longest side.
    const Rgb found = slab.light(Thickness::nearest, PointLight{.position = {0, 0, -0.5}});
    const Rgb expected = 4 * transmittedCosine(1, 1.3) * slab.through(1.5);
    EXPECT_NEAR(found.r, expected.r, 1e-4 * expected.r);
}

// [Freude2014] Fig. 6.27: the light falls onto something else first. A shadow map sees one thick object.
TEST(BackLight, GapsAreNoMaterial) {
    Mesh mesh;
    addBox(mesh, -10, -9.5f);
    addBox(mesh, 0, 1.5f);
    Case two(mesh, 1.5f);
    const double t12 = 2 * transmittedCosine(1, 1.3);
    EXPECT_NEAR(two.light(Thickness::outermost, from_behind).r, t12 * two.through(11.5).r, 1e-3 * two.through(11.5).r);
    EXPECT_NEAR(two.light(Thickness::material, from_behind).r, t12 * two.through(2).r, 1e-3 * two.through(2).r);
    // The back of the nearer one lies in shadow.
    EXPECT_EQ(two.light(Thickness::nearest, from_behind), (Rgb{}));
}

}  // namespace
}  // namespace searchlight
