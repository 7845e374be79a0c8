#include <fmt/format.h>
#include <hwy/highway.h>
#include <hwy/targets.h>

#include "base/error.h"
#include "instruction_sets.h"
#include "judge.h"
#include "light/light_sampler.h"
#include "mesh_shapes.h"
#include "transport/mesh/facet_beams.h"
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

BodyResult exitance(const MeshBody& body, const Medium& medium, const Illumination& light, std::uint64_t seed) {
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
Estimate seenFromAllSides(const MeshBody& body, const Medium& medium, const Illumination& light, double side,
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
    for (const double angle_deg : {0.0, 50.0})
        for (const double eta : {1.0, 1.3}) {
            if (angle_deg == 0 && eta != 1) continue;
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
        const Estimate seen = seenFromAllSides(body, medium, &lights, 2.2, 1000 * seed++, 120);
        // Rays from 300 mm are not quite parallel: 1e-4.
        judge.compare(
            what, {seen.mean - left.mean, std::hypot(seen.standard_error, left.standard_error, 1e-4 * left.mean), 1},
            0);
        EXPECT_LT(seen.standard_error, 0.07 * seen.mean) << what;
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

// Below a wide facet, far from its edges: refraction of a plane wave, and of light from a point by two neighbouring
// rays.
TEST(FacetBeams, AreRefractedLight) {
    const MeshBody body(boxMesh({4, 1, 4}), {.cell_area_mm2 = 1, .shortest_mfp = 0.5});
    const BodyMedium medium{2, 0.1, 0, 1.4};
    Scene scene;
    scene.object = "sphere";
    SplitMix64 random(1);
    const auto below = [&](Vec3 place) {
        const LightSampler lights(scene, placeObject(scene));
        const FacetBeams beams(body, medium, lights, 0);
        double sum = 0;
        std::uint64_t rays = 0;
        constexpr int times = 20'000;  // the roulette of weak beams: 1.3 %
        for (int i = 0; i < times; ++i) sum += beams.scattered(toFloat(place), {0, 0, 1}, random, rays) / times;
        return 4 * pi * 1.4 * 1.4 * sum;
    };
    const auto across = [](double sine) {  // T12 cos / cos' of a direction outside
        const double c = std::sqrt(1 - sine * sine), t = std::sqrt(1 - sine * sine / 1.96);
        const double s = (c - 1.4 * t) / (c + 1.4 * t), p = (1.4 * c - t) / (1.4 * c + t);
        return (1 - 0.5 * (s * s + p * p)) * c / t;
    };
    scene.scale = 2;
    scene.lights = {DirectionalLight{.direction = {3, 4, 0}, .irradiance = {5, 1, 1}}};
    const double cosine = std::sqrt(1 - 0.36 / 1.96);
    const double plane = 5 * across(0.6) * std::exp(-2 * 0.7 / cosine);
    EXPECT_NEAR(below({0.1, 0.3, 0.2}), plane, 0.05 * plane);

    scene.lights = {PointLight{.position = {1, 2, 0.5}, .intensity = {5, 1, 1}}};
    const Vec3 source = placeObject(scene).longest_mm * Vec3{1, 2, 0.5};
    // Rays from the source at polar angle theta reach this far from the foot at a depth; flux between two of them.
    constexpr double depth = 0.7;
    const double height = source.y - 1;
    const auto reached = [&](double theta) {
        return height * std::tan(theta) + depth * std::tan(std::asin(std::sin(theta) / 1.4));
    };
    const double theta = 0.55, step = 1e-5;
    const double ring = (reached(theta + step) - reached(theta - step)) * reached(theta);
    const double solid = std::cos(theta - step) - std::cos(theta + step);
    const double inside = std::asin(std::sin(theta) / 1.4),
                 t12 = across(std::sin(theta)) * std::cos(inside) / std::cos(theta);
    // Intensity is at the distance of the object's longest side; flux per area across the ray.
    const double intensity = 5 * std::pow(placeObject(scene).longest_mm, 2);
    const double spread = intensity * t12 * solid / (ring * std::cos(inside)) * std::exp(-2 * depth / std::cos(inside));
    EXPECT_NEAR(below({source.x - reached(theta), 1 - depth, source.z}), spread, 0.05 * spread);
}

// Straight through a box light meets its far side under the normal.
TEST(FacetBeams, KnowWhatIsMirroredBeforeItScatters) {
    const MeshBody body(boxMesh({4, 1, 4}), {.cell_area_mm2 = 1, .shortest_mfp = 0.5});
    Scene scene;
    scene.object = "sphere";
    scene.lights = {DirectionalLight{.direction = {0, 1, 0}}};
    const LightSampler lights(scene, placeObject(scene));
    const FacetBeams beams(body, {0.5, 0, 0, 1.4}, lights, 0);
    EXPECT_NEAR(beams.mirrored(), std::exp(-0.5 * 2) * std::pow(0.4 / 2.4, 2), 1e-6);
}

TEST(BodyRadiance, StatesItsErrors) {
    const Ball ball(1, 0.5);
    const Medium medium = channelMedium(0.3, 3, 0, 1.3);
    Scene scene;
    scene.lights = {DirectionalLight{.direction = {1, 2, 3}, .angle_deg = 60}};
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
    EXPECT_THROW(walkRadiance(ball, channelMedium(0, 1, 0, 1.3), 0, &lights, camera, {}, observer), Error);
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
