#include "render/light_view/light_map.h"

#include <cmath>

#include "geometry/surface_points.h"
#include "light/transmitted_cosine.h"
#include "model/plane.h"
#include "render/light_view/ring_filter.h"
#include "render/renderer.h"
#include "scene/materials.h"

namespace searchlight {
namespace {

// What maps are made from, for a built-in object.
struct Lit {
    Scene scene;
    Object object;
    RayScene rays;
    RenderInput input;

    Lit(const char* name, std::vector<Light> lights)
        : scene{.object = name, .scale = 20, .lights = std::move(lights)},
          object(placeObject(scene)),
          rays(object.mesh) {
        input.scene = &scene;
        input.object = &object;
        input.rays = &rays;
        input.light = {.eta = 1.4, .light_samples = 256};
    }

    LightMaps maps(int resolution = 256) {
        Observer quiet;
        return lightMaps(input, resolution, quiet);
    }
};

// Flux that crossed into the medium, by the texels of a map.
double fluxOf(const LightMap& map) {
    double sum = 0;
    for (std::size_t k = 0; k < map.cells.size(); k += LightMap::floats) {
        const double depth = map.cells[k];
        if (map.cells[k + 3] > 0) sum += map.cells[k + 5] * (map.central ? 1 / (depth * depth * depth) : 1.0);
    }
    return sum * map.texel * map.texel;
}

double fluxOf(const LightMaps& maps) {
    double sum = 0;
    for (const LightMap& map : maps.maps) sum += fluxOf(map);
    for (std::size_t i = 0; i < maps.grazed_light.size(); ++i)
        sum += static_cast<double>(maps.grazed.areas[i]) * static_cast<double>(maps.grazed_light[i].g);
    return sum;
}

// The same by points on the surface.
double fluxOnSurface(Lit& lit) {
    Observer quiet;
    const PointCloud points = samplePoints(lit.object.mesh, {.count = 12'000}, quiet);
    const Irradiance light =
        computeIrradiance({points.positions, points.normals}, lit.scene, lit.object, &lit.rays, lit.input.light, quiet);
    double sum = 0;
    for (std::size_t i = 0; i < points.areas.size(); ++i)
        sum += static_cast<double>(points.areas[i]) * static_cast<double>(light.transmitted[i].g);
    return sum;
}

TEST(LightMaps, OfASphereUnderParallelLightHoldItsFlux) {
    Lit lit("sphere", {DirectionalLight{.direction = {1, 2, 0.5}}});
    const LightMaps maps = lit.maps();
    ASSERT_EQ(maps.maps.size(), 1u);
    // 2 pi R^2 times the integral of T12(mu) mu.
    double expected = 0;
    constexpr int steps = 2000;
    for (int i = 0; i < steps; ++i) expected += transmittedCosine((i + 0.5) / steps, 1.4) / steps;
    expected *= 2 * 3.14159265358979 * 100;
    // 0.3 %: texels across the rim of 256, where next to nothing crosses, and 36,000 triangles for a sphere.
    EXPECT_NEAR(fluxOf(maps), expected, 0.003 * expected);
}

TEST(LightMaps, OfEveryKindOfLightHoldTheFluxOnTheSurface) {
    // 1 %: points that stand for the surface and texels, each at the borders of shadows; 2 % in 14 views, which see
    // all but the deepest folds and meet along borders of texels.
    Lit parallel("torus_knot", {DirectionalLight{.direction = {1, 1, 1}}});
    EXPECT_NEAR(fluxOf(parallel.maps()) / fluxOnSurface(parallel), 1, 0.01);
    Lit point("torus_knot", {PointLight{.position = {1, 0.5, 0.7}}});
    ASSERT_EQ(point.maps().maps.size(), 1u);
    EXPECT_TRUE(point.maps().maps.front().central);
    EXPECT_NEAR(fluxOf(point.maps()) / fluxOnSurface(point), 1, 0.01);
    Lit disc("torus_knot", {DirectionalLight{.direction = {1, 1, 1}, .angle_deg = 20}});
    EXPECT_EQ(disc.maps(64).views, 14);
    EXPECT_NEAR(fluxOf(disc.maps(128)) / fluxOnSurface(disc), 1, 0.02);
    Lit close("sphere", {PointLight{.position = {0.4, 0.3, 0.35}}});
    EXPECT_EQ(close.maps(64).spread_lights, 1);
    EXPECT_NEAR(fluxOf(close.maps(128)) / fluxOnSurface(close), 1, 0.02);
}

TEST(LightMaps, HoldWhatShadingNormalsLightOnTrianglesThatAreTurnedAway) {
    Lit lit("sphere", {DirectionalLight{.direction = {1, 2, 0.5}}});
    lit.object.mesh = builtInObject("sphere", -4);
    for (Vec3f& position : lit.object.mesh.positions) position = toFloat(20 * toDouble(position));
    lit.rays = RayScene(lit.object.mesh);
    LightMaps maps = lit.maps();
    const double whole = fluxOf(maps), on_surface = fluxOnSurface(lit);
    EXPECT_NEAR(whole / on_surface, 1, 0.01);
    maps.grazed_light.clear();
    EXPECT_LT(fluxOf(maps), whole * 0.999);  // 0.2 % here, 0.8 % of a bunny of 7,000 triangles
}

TEST(LightMaps, OfSeveralLightsAreOneEach) {
    Lit lit("sphere", {DirectionalLight{.direction = {1, 0, 0}}, PointLight{.position = {0, 2, 0}},
                       DirectionalLight{.direction = {0, 0, 1}, .irradiance = {}}});
    const LightMaps maps = lit.maps(64);
    EXPECT_EQ(maps.views, 3);
    EXPECT_EQ(maps.maps.size(), 2u);  // the dark one is not kept
}

Profile exponential(double mean_mm) {
    std::vector<double> radii;
    std::vector<Rgb> values;
    for (int i = 0; i <= 400; ++i) {
        const double r = 14 * mean_mm * i / 400;
        radii.push_back(r);
        values.push_back(std::exp(-r / mean_mm) * Rgb{1, 0.5, 2});
    }
    return {std::move(radii), std::move(values)};
}

// A map of a plane that is seen at a tilt, evenly lit, and one receiver in the middle of it.
struct TiltedPlane {
    LightMap map;
    RingReceivers receiver;

    TiltedPlane(double tilt_deg, double side_mm, bool central) {
        const double tilt = tilt_deg * 3.14159265358979 / 180;
        const Vec3 normal{std::sin(tilt), 0, -std::cos(tilt)};
        const double away = central ? 100 : 0, texel = side_mm / 128 / (central ? away : 1);
        map = {.central = central, .right = {1, 0, 0}, .up = {0, 1, 0}, .forward = {0, 0, 1}};
        map.origin = {0, 0, -away};
        map.width = map.height = 128;
        map.texel = static_cast<float>(texel);
        map.u0 = map.v0 = static_cast<float>(-64 * texel);
        map.cells.resize(130 * 130 * LightMap::floats);
        const double h = std::abs(dot(normal, map.origin)), scale = central ? texel / h : texel / -normal.z;
        for (int y = 0; y < 128; ++y)
            for (int x = 0; x < 128; ++x) {
                const double u = (x - 63.5) * texel, v = (y - 63.5) * texel;
                float* cell = &map.cells[map.cellAt(x, y)];
                const double over_u = central ? -normal.x * scale : normal.x * scale;
                cell[0] = static_cast<float>((central ? 1 / away : 0) + over_u * (u / texel) + 0 * v);
                cell[1] = static_cast<float>(over_u);
                cell[2] = 0;
                cell[3] = 1;
                const double area = central ? 1 / h : 1 / -normal.z;
                cell[4] = cell[5] = cell[6] = static_cast<float>(area);
            }
        VisibleSurface visible{.width = 1, .height = 1};
        visible.pixels = {0};
        visible.positions = {{0, 0, 0}};
        visible.geometric_normals = {toFloat(normal)};
        receiver = RingReceivers(visible);
    }
};

TEST(RingFilter, EvenLightOnAPlaneLeavesTheTotalAtAnyTilt) {
    const Profile profile = exponential(1.5);
    Observer quiet;
    for (const bool central : {false, true})
        for (const double tilt : {0.0, 40.0, 65.0}) {
            const TiltedPlane plane(tilt, 120, central);
            std::vector<Rgbf> exitance(1);
            RingFilter(profile, 401, 1e3, 1).gather(plane.map, plane.receiver, 1, quiet, exitance);
            // 401 samples of two kinds that share the weight: a few thousandths of quadrature.
            EXPECT_NEAR(exitance[0].r / profile.total().r, 1, 0.01) << tilt << " " << central;
            EXPECT_NEAR(exitance[0].b / profile.total().b, 1, 0.01) << tilt << " " << central;
        }
}

TEST(RingFilter, HasRingsSpokesAndAMiddle) {
    const RingFilter filter(exponential(1), 401, 100, 1);
    EXPECT_EQ(filter.rings(), 20);
    EXPECT_EQ(filter.spokes(), 20);
    const RingFilter one(exponential(1), 1, 100, 1);
    EXPECT_EQ(one.rings(), 0);
    EXPECT_EQ(one.spokes(), 0);
}

}  // namespace
}  // namespace searchlight
