#include <fmt/format.h>
#include <hwy/highway.h>
#include <hwy/targets.h>

#include "base/error.h"
#include "instruction_sets.h"
#include "judge.h"
#include "light/light_sampler.h"
#include "mesh_shapes.h"
#include "transport/mesh/facet_beams.h"
#include "transport/mesh/first_orders.h"
#include "transport/mesh/radiance_body.h"

namespace searchlight {
namespace {

constexpr double pi = std::numbers::pi;

// A camera far away in a direction, whose square picture is `side` mm wide at the origin.
CameraRays farCamera(Vec3 direction, double distance, double side, int pixels) {
    const Vec3 up = std::abs(direction.y) < 0.9 ? Vec3{0, 1, 0} : Vec3{1, 0, 0};
    const Vec3 right = normalize(cross(up, direction)), down = cross(right, direction);
    CameraRays rays{pixels, pixels, distance * direction, {}, (side / pixels) * right, (side / pixels) * down};
    rays.corner = (-distance) * direction - (0.5 * pixels) * (rays.right + rays.down);
    return rays;
}

// Radiance times projected area over the whole picture, mm^2, and its standard error.
Estimate totalOf(const BodyRadiance& picture, double side, int pixels) {
    const double area = side * side / pixels / pixels;
    double sum = 0, square = 0;
    for (std::size_t i = 0; i < picture.radiance.size(); ++i) {
        sum += picture.radiance[i];
        square += picture.standard_error[i] * picture.standard_error[i];
    }
    return {area * sum, area * std::sqrt(square), picture.walks};
}

template <class Body>
BodyResult exitance(const Body& body, const Medium& medium, const Illumination& light, std::uint64_t seed) {
    Observer observer;
    return walkBody(body, medium, 0, light, {.walks = 400'000, .seed = seed}, observer);
}

// Seen from afar a sphere shows each of its directions once: in uniform light, by symmetry, radiance over the picture's
// area is R^2 M.
TEST(BodyRadiance, OfASphereInUniformLightIsItsExitance) {
    Judge judge;
    Observer observer;
    const Ball ball(1, 0.5);
    std::uint64_t seed = 1;
    for (const double eta : {1.0, 1.4})
        for (const double sigma_a : {0.0, 0.3}) {
            const Medium medium = channelMedium(sigma_a, 3, 0.4, eta);
            constexpr int pixels = 64;
            const CameraRays camera = farCamera({0, 0, 1}, 1e4, 2.2, pixels);
            const BodyRadiance seen = walkRadiance(ball, medium, 0, UniformLight{}, camera,
                                                   {.walks_per_pixel = 40, .seed = seed++}, observer);
            const BodyResult left =
                walkBody(ball, medium, 0, UniformLight{}, {.walks = 400'000, .seed = seed++}, observer);
            const Estimate total = totalOf(seen, 2.2, pixels);
            const double truth = left.left.mean / ball.area();
            const double error = left.left.standard_error / ball.area();
            judge.compare(fmt::format("eta {}, sigma_a {}", eta, sigma_a),
                          {total.mean - truth, std::hypot(total.standard_error, error), 1}, 0);
            if (sigma_a == 0)
                judge.compare(fmt::format("equilibrium, eta {}", eta), total, pi * diffuseTransmittance(eta));
            EXPECT_EQ(seen.lost, 0u);
        }
    judge.expectAgreement();
}

// Whatever lights a convex body: its pictures from all directions, four pi times their mean, are all that leaves it.
// The error is that of the mean over cameras.
template <class Body>
Estimate seenFromAllSides(const Body& body, const Medium& medium, const Illumination& light, double side,
                          std::uint64_t seed, int cameras = 600) {
    constexpr int pixels = 16;
    Observer observer;
    SplitMix64 random(seed);
    double sum = 0, square = 0;
    for (int i = 0; i < cameras; ++i) {
        const double y = 2 * (i + random.uniform()) / cameras - 1, ring = std::sqrt(1 - y * y),
                     turn = 2 * pi * random.uniform();
        const CameraRays camera = farCamera({ring * std::cos(turn), y, ring * std::sin(turn)}, 300, side, pixels);
        const BodyRadiance picture =
            walkRadiance(body, medium, 0, light, camera,
                         {.walks_per_pixel = 4, .seed = seed + static_cast<std::uint64_t>(i)}, observer);
        const double total = 4 * pi * totalOf(picture, side, pixels).mean;
        sum += total, square += total * total;
    }
    const double mean = sum / cameras;
    return {mean, std::sqrt((square / cameras - mean * mean) / (cameras - 1)), static_cast<std::uint64_t>(cameras)};
}

TEST(BodyRadiance, FromAllSidesIsWhatLeavesABox) {
    Judge judge;
    const MeshBody body(boxMesh({1, 0.6, 0.8}), {.cell_area_mm2 = 0.5, .shortest_mfp = 0.4});
    Scene scene;
    scene.object = "sphere";
    std::uint64_t seed = 1;
    for (const double angle_deg : {0.0, 20.0, 50.0})  // asked by shadow rays or beams, and met
        for (const double eta : {1.0, 1.3}) {
            if (angle_deg == 0 && eta != 1) continue;
            if (angle_deg == 20 && eta == 1) continue;
            scene.lights = {DirectionalLight{.direction = {1, 2, 3}, .irradiance = {2, 1, 1}, .angle_deg = angle_deg}};
            const LightSampler lights(scene, placeObject(scene));
            const Medium medium = channelMedium(0.1, 2.4, 0.3, eta);
            Estimate left = exitance(body, medium, &lights, seed++).left;
            if (angle_deg == 0) {
                // No camera looks into parallel light that passes unscattered: what a body that only absorbs lets pass.
                const double sigma_t = medium.sigmaT().r;
                const Estimate passes =
                    exitance(body, channelMedium(sigma_t * (1 - 1e-12), sigma_t * 1e-12), &lights, seed++).left;
                left = {left.mean - passes.mean, std::hypot(left.standard_error, passes.standard_error), 1};
            }
            const Estimate seen = seenFromAllSides(body, medium, &lights, 3, 1000 * seed++);
            // Rays from 300 mm are not quite parallel: 1e-4.
            judge.compare(
                fmt::format("angle {}, eta {}", angle_deg, eta),
                {seen.mean - left.mean, std::hypot(seen.standard_error, left.standard_error, 1e-4 * left.mean), 1}, 0);
            EXPECT_LT(seen.standard_error, 0.05 * seen.mean);
        }
    judge.expectAgreement();
}

// Light of single directions and points, which no walk meets, through refractive facets.
TEST(BodyRadiance, OfBeamsFromAllSidesIsWhatLeaves) {
    Judge judge;
    const MeshBody body(sphereMesh(1, 3), {.cell_area_mm2 = 0.5, .shortest_mfp = 1 / 12.0});
    const Medium medium = channelMedium(0.4, 11.6, 0.3, 1.3);
    Scene scene;
    scene.object = "sphere";
    std::uint64_t seed = 1;
    const auto judged = [&](const char* what) {
        const LightSampler lights(scene, placeObject(scene));
        const Estimate left = exitance(body, medium, &lights, seed++).left;
        const Estimate seen = seenFromAllSides(body, medium, &lights, 2.2, 1000 * seed++, 90);
        // Rays from 300 mm are not quite parallel: 1e-4.
        judge.compare(
            what, {seen.mean - left.mean, std::hypot(seen.standard_error, left.standard_error, 1e-4 * left.mean), 1},
            0);
        EXPECT_LT(seen.standard_error, 0.08 * seen.mean) << what;
    };
    scene.lights = {DirectionalLight{.direction = {1, 2, 3}, .irradiance = {2, 1, 1}}};
    judged("direction");
    // In longest sides of the object, near enough for its light to spread inside.
    scene.lights = {PointLight{.position = {0.8, 0.5, 0}, .intensity = {3, 1, 1}}};
    judged("point");
    scene.lights.push_back(DirectionalLight{.direction = {-1, 2, 0}, .irradiance = {1, 1, 1}, .angle_deg = 40});
    judged("point and disc");
    judge.expectAgreement();
}

// A body that is thin against the mean free path, in which most of the light meets a side under total reflection before
// it scatters.
TEST(BodyRadiance, OfMirroredBeamsFromAllSidesIsWhatLeaves) {
    Judge judge;
    const MeshBody body(boxMesh({0.5, 0.3, 0.4}), {.cell_area_mm2 = 0.1, .shortest_mfp = 1});
    const Medium medium = channelMedium(0.2, 0.8, 0.3, 1.6);
    Scene scene;
    scene.object = "sphere";
    Observer observer;
    std::uint64_t seed = 1;
    for (const bool near : {false, true}) {
        if (near)
            scene.lights = {PointLight{.position = {0.4, 0.7, 0.5}, .intensity = {1, 1, 1}}};
        else
            scene.lights = {DirectionalLight{.direction = {1, 2, 3}, .irradiance = {2, 1, 1}}};
        const LightSampler lights(scene, placeObject(scene));
        const FacetBeams beams(body, {1, 0.2, 0.3, 1.6}, lights, 0);
        EXPECT_GE(beams.orders(), 2u);
        const double left_out = near ? 0.017 : 0.004;
        EXPECT_LT(beams.mirrored(), left_out);
        EXPECT_GT(FacetBeams(body, {1, 0.2, 0.3, 1.6}, lights, 0, 0).mirrored(), 0.2);
        const Estimate left = exitance(body, medium, &lights, seed++).left;
        const FirstOrders passes =
            walkFirstOrders(body, medium, 0, &lights, {.walks = 100'000, .seed = seed++}, observer, false);
        double unscattered = 0;
        for (std::size_t cell = 0; cell < body.cellCount(); ++cell)
            unscattered += body.cellArea(cell) * passes.unscattered[cell];
        const double truth = left.mean - unscattered;
        const Estimate seen = seenFromAllSides(body, medium, &lights, 1.5, 1000 * seed++, 150);
        // Rays from 300 mm are not quite parallel: 1e-4. What passes is known to 0.3 % of itself.
        judge.compare(near ? "point" : "direction",
                      {seen.mean - truth,
                       std::hypot(seen.standard_error, left.standard_error, 3e-3 * unscattered + left_out * truth), 1},
                      0);
        EXPECT_LT(seen.standard_error, 0.05 * seen.mean);
    }
    judge.expectAgreement();
}

// Of the light that enters a sphere of radius 1 under parallel light, irradiance 1, what leaves it without having
// scattered: no camera looks into it.
double passesUnscattered(double sigma_t, double eta) {
    constexpr int steps = 20'000;
    double sum = 0;
    for (int i = 0; i < steps; ++i) {
        const double s = (i + 0.5) / steps, c = std::sqrt(1 - s * s), t = std::sqrt(1 - s * s / (eta * eta));
        const double rs = (c - eta * t) / (c + eta * t), rp = (eta * c - t) / (eta * c + t);
        const double mirrored = 0.5 * (rs * rs + rp * rp), passed = std::exp(-2 * sigma_t * t);
        sum += 2 * pi * s * (1 - mirrored) * (1 - mirrored) * passed / (1 - mirrored * passed) / steps;
    }
    return sum;
}

// Through the smooth surface, thin enough for light that was mirrored inside to count.
TEST(BodyRadiance, OfASmoothSphereFromAllSidesIsWhatLeaves) {
    Judge judge;
    const Ball ball(1, 0.5);
    Scene scene;
    scene.object = "sphere";
    scene.lights = {DirectionalLight{.direction = {1, 2, 3}, .irradiance = {2, 1, 1}}};
    const LightSampler lights(scene, placeObject(scene));
    std::uint64_t seed = 1;
    for (const double sigma_t : {0.5, 12.0}) {
        const Medium medium = channelMedium(0.05 * sigma_t, 0.95 * sigma_t, 0.3, 1.4);
        const Estimate left = exitance(ball, medium, &lights, seed++).left;
        const double scattered = left.mean - 2 * passesUnscattered(sigma_t, 1.4);
        const Estimate seen = seenFromAllSides(ball, medium, &lights, 2.2, 1000 * seed++, 120);
        // Rays from 300 mm are not quite parallel: 1e-4.
        judge.compare(
            fmt::format("sigma_t {}", sigma_t),
            {seen.mean - scattered, std::hypot(seen.standard_error, left.standard_error, 1e-4 * scattered), 1}, 0);
        EXPECT_LT(seen.standard_error, 0.07 * seen.mean);
    }
    judge.expectAgreement();
}

// A mesh of 8,192 facets is 3e-4 smaller, and what bends light is its facets.
TEST(BodyRadiance, OfASmoothSphereIsThatOfManyFacets) {
    Judge judge;
    const Ball ball(1, 0.5);
    const Medium medium = channelMedium(0.3, 2.7, 0.3, 1.3);
    const MeshBody mesh(sphereMesh(1, 5), {.cell_area_mm2 = 0.5, .shortest_mfp = 1 / 3.0});
    Scene scene;
    scene.object = "sphere";
    Observer observer;
    for (const bool near : {false, true}) {
        if (near)
            scene.lights = {PointLight{.position = {0, 0, 0.9}, .intensity = {1, 1, 1}}};
        else
            scene.lights = {DirectionalLight{.direction = {1, 2, 3}, .irradiance = {1, 1, 1}}};
        const LightSampler lights(scene, placeObject(scene));
        const CameraRays camera = farCamera({0, 0.6, 0.8}, 300, 2.2, 3);
        const BodyRadianceOptions options{.walks_per_pixel = 5'000};
        const BodyRadiance smooth = walkRadiance(ball, medium, 0, &lights, camera, options, observer);
        const BodyRadiance facets = walkRadiance(mesh, medium, 0, &lights, camera, options, observer);
        for (std::size_t i = 0; i < smooth.radiance.size(); ++i) {
            const double error = std::hypot(smooth.standard_error[i], facets.standard_error[i]);
            // The mesh leaves out light that was mirrored before it scattered.
            const double off = 2e-3 * smooth.radiance[i];
            judge.compare(fmt::format("near {}, pixel {}", near, i),
                          {facets.radiance[i] - smooth.radiance[i], std::hypot(error, off), 1}, 0);
            EXPECT_LT(error, 0.1 * smooth.radiance[i]);
        }
    }
    judge.expectAgreement();
}

// Discs of 40 degrees are asked for, those that are a little wider are met. Pixel by pixel, where facets meet and
// behind a part that hides the light, too.
TEST(BodyRadiance, OfANarrowDiscIsWhatWalksMeet) {
    Judge judge;
    Observer observer;
    const MeshBody body(sphereMesh(1, 2), {.cell_area_mm2 = 0.5, .shortest_mfp = 1 / 12.0});
    const Medium medium = channelMedium(0.4, 11.6, 0.3, 1.3);
    constexpr int pixels = 6;
    const CameraRays camera = farCamera(normalize({1, 0.2, -0.4}), 300, 2, pixels);
    Scene scene;
    scene.object = "sphere";
    const auto picture = [&](double angle_deg, std::uint64_t walks, std::uint64_t seed) {
        scene.lights = {DirectionalLight{.direction = {1, 2, 3}, .irradiance = {2, 1, 1}, .angle_deg = angle_deg}};
        const LightSampler lights(scene, placeObject(scene));
        EXPECT_EQ(lights.narrow(), angle_deg <= 40);
        return walkRadiance(body, medium, 0, &lights, camera, {.walks_per_pixel = walks, .seed = seed}, observer);
    };
    // Radiance differs by 5e-4.
    const BodyRadiance asked = picture(40, 2000, 1), met = picture(40.01, 20'000, 2);
    for (std::size_t i = 0; i < asked.radiance.size(); ++i)
        judge.compare(fmt::format("pixel {}", i),
                      {asked.radiance[i] - met.radiance[i],
                       std::hypot(asked.standard_error[i], met.standard_error[i], 5e-4 * met.radiance[i]), 1},
                      0);
    judge.expectAgreement();
    EXPECT_EQ(asked.mirrored, 0);
}

// By the scatter over seeds, of a wide light, and of a wide and a parallel one: these are found in two ways by one
// walk.
void expectErrorsStated(const std::vector<Light>& found) {
    const Ball ball(1, 0.5);
    const Medium medium = channelMedium(0.3, 3, 0, 1.3);
    Scene scene;
    scene.lights = found;
    const LightSampler lights(scene, placeObject(scene));
    const CameraRays camera = farCamera({1, 0, 0}, 100, 1.2, 4);
    Observer observer;
    constexpr int seeds = 80;
    std::vector<double> sum(16), squares(16), stated(16);
    for (int seed = 1; seed <= seeds; ++seed) {
        const BodyRadiance r =
            walkRadiance(ball, medium, 0, &lights, camera,
                         {.walks_per_pixel = 400, .seed = static_cast<std::uint64_t>(seed)}, observer);
        for (std::size_t i = 0; i < sum.size(); ++i) {
            sum[i] += r.radiance[i];
            squares[i] += r.radiance[i] * r.radiance[i];
            stated[i] += r.standard_error[i] * r.standard_error[i] / seeds;
        }
    }
    double ratio = 0;
    for (std::size_t i = 0; i < sum.size(); ++i)
        ratio += (squares[i] - sum[i] * sum[i] / seeds) / (seeds - 1) / stated[i] / 16;
    // 80 seeds x 16 pixels know the ratio to 4 %.
    EXPECT_NEAR(ratio, 1, 0.16);
}

TEST(BodyRadiance, StatesItsErrors) { expectErrorsStated({DirectionalLight{.direction = {1, 2, 3}, .angle_deg = 60}}); }

TEST(BodyRadiance, StatesItsErrorsUnderLightsOfBothKinds) {
    expectErrorsStated({DirectionalLight{.direction = {1, 2, 3}, .irradiance = {0.3, 0.3, 0.3}, .angle_deg = 60},
                        DirectionalLight{.direction = {1, 2, 3}, .irradiance = {0.05, 0.05, 0.05}}});
}

TEST(BodyRadiance, DoesNotDependOnThreads) {
    const MeshBody body(sphereMesh(1, 3), {.cell_area_mm2 = 0.1, .shortest_mfp = 0.3});
    const Medium medium = channelMedium(0.1, 3, 0.2, 1.3);
    const CameraRays camera = farCamera({0, 1, 0}, 100, 2.2, 16);
    Observer observer;
    const auto walk = [&](int threads) {
        return walkRadiance(body, medium, 0, UniformLight{}, camera, {.walks_per_pixel = 9, .threads = threads},
                            observer);
    };
    const BodyRadiance one = walk(1), two = walk(2);
    EXPECT_EQ(one.radiance, two.radiance);
    EXPECT_EQ(one.standard_error, two.standard_error);
}

TEST(BodyRadiance, RefusesLightThatNoWalkMeets) {
    Scene scene;
    scene.lights = {DirectionalLight{.direction = {1, 2, 3}}};
    const LightSampler lights(scene, placeObject(scene));
    const Ball ball(1, 0.5);
    const CameraRays camera = farCamera({0, 1, 0}, 100, 2.2, 4);
    Observer observer;
    EXPECT_THROW(walkRadiance(ball, channelMedium(0, 1, 0, 1.3), 0, PencilLight{}, camera, {}, observer), Error);
    EXPECT_THROW(walkRadiance(ball, channelMedium(0, 1), 0, PencilLight{}, camera, {}, observer), Error);
    EXPECT_THROW(walkRadiance(ball, channelMedium(1, 0), 0, UniformLight{}, camera, {}, observer), Error);
    EXPECT_NO_THROW(walkRadiance(ball, channelMedium(0, 1), 0, &lights, camera, {.walks_per_pixel = 1}, observer));
}

// Lanes with FMA do the same arithmetic whatever their number.
TEST(BodyWalk, Avx2AndAvx512AgreeBitForBit) {
    if (!hasInstructionSet(HWY_AVX3)) GTEST_SKIP() << "no AVX-512 here";
    const MeshBody body(sphereMesh(1, 3), {.cell_area_mm2 = 0.1, .shortest_mfp = 0.1});
    const Medium medium = channelMedium(0.2, 10, 0.5, 1.3);
    const auto on = [&](std::int64_t target) {
        hwy::SetSupportedTargetsForTest(target);
        const BodyResult result = exitance(body, medium, UniformLight{}, 3);
        hwy::SetSupportedTargetsForTest(0);
        return result;
    };
    const BodyResult wide = on(HWY_AVX3), narrow = on(HWY_AVX2);
    EXPECT_EQ(wide.exitance, narrow.exitance);
    EXPECT_EQ(wide.collisions, narrow.collisions);
    EXPECT_EQ(wide.rays, narrow.rays);
}

}  // namespace
}  // namespace searchlight
