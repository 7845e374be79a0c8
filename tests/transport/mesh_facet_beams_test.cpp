#include "transport/mesh/facet_beams.h"

#include <algorithm>
#include <numbers>

#include "mesh_shapes.h"

namespace searchlight {
namespace {

constexpr double pi = std::numbers::pi;

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
    const BodyMedium medium{0.5, 0, 0, 1.4};
    const double once = std::exp(-0.5 * 2) * std::pow(0.4 / 2.4, 2);
    EXPECT_NEAR(FacetBeams(body, medium, lights, 0, 0).mirrored(), once, 1e-6);
    EXPECT_NEAR(FacetBeams(body, medium, lights, 0, 1).mirrored(), once * once, 1e-8);
    const FacetBeams beams(body, medium, lights, 0);
    EXPECT_EQ(beams.orders(), 2u);
    EXPECT_NEAR(beams.mirrored(), std::pow(once, 3), 1e-9);
    // A place in the light that goes down and in that which comes back, time and again.
    SplitMix64 random(1);
    std::uint64_t rays = 0;
    double sum = 0;
    constexpr int times = 40'000;  // the roulettes: 0.2 %
    for (int i = 0; i < times; ++i)
        sum += 4 * pi * 1.4 * 1.4 / times * beams.scattered({0.5F, 0.4F, 0.3F}, {1, 0, 0}, random, rays);
    const double down = std::exp(-0.5 * 0.6), back = std::exp(-0.5 * (2 + 1.4)) * std::pow(0.4 / 2.4, 2);
    const double truth = (1 - std::pow(0.4 / 2.4, 2)) * (down + back) / (1 - once * once);
    EXPECT_NEAR(sum, truth, 0.02 * truth);
}

// Beside a disc of the same irradiance, whose mirrored light walks meet, it is half as large a part.
TEST(FacetBeams, LeaveOutMirroredLightOfSingleDirectionsAlone) {
    const MeshBody body(boxMesh({4, 1, 4}), {.cell_area_mm2 = 1, .shortest_mfp = 0.5});
    Scene scene;
    scene.object = "sphere";
    scene.lights = {DirectionalLight{.direction = {0, 1, 0}}, DirectionalLight{.direction = {0, 1, 0}, .angle_deg = 1}};
    const LightSampler lights(scene, placeObject(scene));
    const double once = std::exp(-0.5 * 2) * std::pow(0.4 / 2.4, 2);
    // A third of 8,192 candidates choose one of two lights: 1.9 %.
    EXPECT_NEAR(FacetBeams(body, {0.5, 0, 0, 1.4}, lights, 0, 0).mirrored(), 0.5 * once, 0.08 * 0.5 * once);
}

// From a denser medium a point lights a circle within a wide facet: all corners are under total reflection.
TEST(FacetBeams, EnterWhereAFacetIsPartlyUnderTotalReflection) {
    constexpr double eta = 0.7, height = 1, depth = 0.7, theta = 0.4, step = 1e-5;
    const MeshBody body(boxMesh({4, 1, 4}), {.cell_area_mm2 = 1, .shortest_mfp = 0.5});
    Scene scene;
    scene.object = "sphere";
    const Vec3 source{2, 1 + height, 1};
    const double unit_mm = placeObject(scene).longest_mm;
    scene.lights = {PointLight{.position = (1 / unit_mm) * source, .intensity = {5, 1, 1}}};
    const LightSampler lights(scene, placeObject(scene));
    const FacetBeams beams(body, {2, 0.1, 0, eta}, lights, 0);
    const auto below = [](double angle) { return std::asin(std::sin(angle) / eta); };
    const auto reached = [&](double angle) { return height * std::tan(angle) + depth * std::tan(below(angle)); };
    SplitMix64 random(1);
    std::uint64_t rays = 0;
    double sum = 0;
    constexpr int times = 20'000;  // the roulette of weak beams: 1.3 %
    const Vec3f place = toFloat(Vec3{source.x - reached(theta), 1 - depth, source.z});
    for (int i = 0; i < times; ++i) sum += 4 * pi * eta * eta / times * beams.scattered(place, {0, 0, 1}, random, rays);
    // Flux between two neighbouring rays per area across them, as in AreRefractedLight.
    const double c = std::cos(theta), t = std::cos(below(theta));
    const double s = (c - eta * t) / (c + eta * t), p = (eta * c - t) / (eta * c + t);
    const double ring = (reached(theta + step) - reached(theta - step)) * reached(theta);
    const double solid = std::cos(theta - step) - std::cos(theta + step);
    const double truth =
        5 * unit_mm * unit_mm * (1 - 0.5 * (s * s + p * p)) * solid / (ring * t) * std::exp(-2 * depth / t);
    EXPECT_NEAR(sum, truth, 0.05 * truth);
}

// Of a disc below a facet's horizon but for a sliver of 0.3 degrees, wherever that is on its edge.
TEST(FacetBeams, EnterFromASliverOfADisc) {
    const MeshBody body(boxMesh({4, 1, 4}), {.cell_area_mm2 = 1, .shortest_mfp = 0.25});
    Scene scene;
    scene.object = "sphere";
    SplitMix64 random(1);
    std::uint64_t rays = 0;
    const double elevation = -19.7 * pi / 180;
    for (int i = 0; i < 24; ++i) {
        const double turn = 2 * pi * i / 24;
        scene.lights = {DirectionalLight{.direction = {std::cos(elevation) * std::cos(turn), std::sin(elevation),
                                                       std::cos(elevation) * std::sin(turn)},
                                         .angle_deg = 40}};
        const LightSampler lights(scene, placeObject(scene));
        const FacetBeams beams(body, {4, 0.1, 0, 1.4}, lights, 0);
        double sum = 0;
        for (int k = 0; k < 20'000; ++k) sum += beams.scattered({0.5F, 0.95F, 0.3F}, {0, 0, 1}, random, rays);
        EXPECT_GT(sum, 0) << i;  // 1 in 1,000 directions is in it
    }
}

// Below the top of a box, whose sides cast no light down there: for any direction of the disc, one facet brings it.
TEST(FacetBeams, OfADiscAreItsRefractedLight) {
    const MeshBody body(boxMesh({4, 1, 4}), {.cell_area_mm2 = 1, .shortest_mfp = 0.5});
    Scene scene;
    scene.object = "sphere";
    scene.lights = {DirectionalLight{.direction = {3, 4, 0}, .irradiance = {5, 1, 1}, .angle_deg = 30}};
    const LightSampler lights(scene, placeObject(scene));
    const FacetBeams beams(body, {2, 0.1, 0, 1.4}, lights, 0);
    SplitMix64 random(1);
    std::uint64_t rays = 0;
    constexpr int times = 40'000;
    constexpr double depth = 0.7;
    double found = 0, truth = 0, squares = 0;
    for (int i = 0; i < times; ++i) {
        const double one = 4 * pi * 1.4 * 1.4 * beams.scattered({0.1F, 1 - 0.7F, 0.2F}, {0, 0, 1}, random, rays);
        found += one / times, squares += one * one / times;
        const LightSample light = lights.sampleOf(0, {}, random.uniform(), random.uniform());
        const double c = light.wi.y, t = std::sqrt(1 - (1 - c * c) / 1.96);
        const double s = (c - 1.4 * t) / (c + 1.4 * t), p = (1.4 * c - t) / (1.4 * c + t);
        truth += light.irradiance_over_pdf[0] * (1 - 0.5 * (s * s + p * p)) * c / t * std::exp(-2 * depth / t) / times;
    }
    // The other sum scatters far less.
    EXPECT_NEAR(found, truth, 4 * std::sqrt((squares - found * found) / times));
}

// A wall of the same body stands between the light and the floor beside it, and casts its shadow there.
TEST(FacetBeams, AreHiddenByWhatStandsInTheirWay) {
    // From the side: a block of 4 mm with a step 2 mm high on its left half.
    Mesh mesh;
    const double outline[][2]{{-2, 0}, {2, 0}, {2, 1}, {0, 1}, {0, 3}, {-2, 3}};
    for (const float z : {-2.0F, 2.0F})
        for (const auto& [x, y] : outline) mesh.positions.push_back({static_cast<float>(x), static_cast<float>(y), z});
    const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
        mesh.triangles.push_back({a, b, c});
        mesh.triangles.push_back({a, c, d});
    };
    for (std::uint32_t i = 0; i < 6; ++i) quad(i, (i + 1) % 6, (i + 1) % 6 + 6, i + 6);
    for (std::uint32_t i = 1; i < 5; ++i) {
        mesh.triangles.push_back({i + 1, i, 0});
        mesh.triangles.push_back({6, i + 6, i + 7});
    }
    const MeshBody body(mesh, {.cell_area_mm2 = 1, .shortest_mfp = 1});
    Scene scene;
    scene.object = "sphere";
    for (const double angle_deg : {0.0, 10.0}) {
        const auto below = [&](Vec3 to, Vec3f place) {
            scene.lights = {DirectionalLight{.direction = to, .angle_deg = angle_deg}};
            const LightSampler lights(scene, placeObject(scene));
            const FacetBeams beams(body, {1, 0.1, 0, 1.4}, lights, 0, 0);
            SplitMix64 random(1);
            std::uint64_t rays = 0;
            double sum = 0;
            for (int i = 0; i < 2'000; ++i) sum += beams.scattered(place, {0, 0, 1}, random, rays);
            return sum;
        };
        const Vec3f floor{0.5F, 0.7F, 0.1F};
        EXPECT_GT(below({1, 1, 0}, floor), 0);   // from the open side
        EXPECT_EQ(below({-1, 2, 0}, floor), 0);  // over the wall: in its shadow; what enters the wall leaves it first
        EXPECT_GT(below({-1, 2, 0}, {1.8F, 0.7F, 0.1F}), 0);    // beyond the shadow
        EXPECT_GT(below({1, 0.2, 0}, {-0.2F, 2, 0.1F}), 0);     // from the open side into the wall
        EXPECT_GT(below({1, -0.5, 0}, {1.5F, 0.5F, 0.1F}), 0);  // into the block's side
    }
}

// Near a facet light goes every way, and its slices never leave the mesh.
TEST(BeamCells, EndWithTheMeshHoweverLongTheSweep) {
    const BeamCells cells(boxMesh({1, 1, 1}));
    std::vector<int> visits(cells.count());
    cells.forEach({{{-1, 1, -1}, {1, 1, 1}}, {{-1, -1, -1}, {1, 1, 1}}, 1e9},
                  [&](std::size_t at, double) { ++visits[at]; });
    const auto [fewest, most] = std::ranges::minmax(visits);
    EXPECT_GE(fewest, 1);
    EXPECT_LE(most, 15);  // slices of a cell along the diagonal of 8 x 8 x 8
}

}  // namespace
}  // namespace searchlight
