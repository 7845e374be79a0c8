// Walks on every instruction set. Those with fused multiply-adds agree bit for bit whatever their number of lanes, with
// the pilots that steer them; the others draw other samples and agree statistically.
#include <fmt/format.h>
#include <hwy/highway.h>
#include <hwy/targets.h>

#include "instruction_sets.h"
#include "judge.h"
#include "light/light_sampler.h"
#include "mesh_shapes.h"
#include "transport/half_space/half_space.h"
#include "transport/mesh/radiance_body.h"
#include "transport/slab/slab.h"

namespace searchlight {
namespace {

using Numbers = std::vector<double>;

// What a walk that draws the numbers of a seed ends with: values, and their standard errors after them.
struct Found {
    Numbers mean, error;

    void add(const Estimate& e) { mean.push_back(e.mean), error.push_back(e.standard_error); }
    void add(const Numbers& means, const Numbers& errors) {
        mean.insert(mean.end(), means.begin(), means.end());
        error.insert(error.end(), errors.begin(), errors.end());
    }
    bool operator==(const Found&) const = default;
};

template <class Walk>
Found on(std::int64_t target, const Walk& walk, double part, std::uint64_t seed) {
    hwy::SetSupportedTargetsForTest(target);
    Found found = walk(part, seed);
    hwy::SetSupportedTargetsForTest(0);
    return found;
}

Found halfSpace(const HalfSpaceProblem& problem, Estimator estimator, double walks, std::uint64_t seed) {
    HalfSpaceOptions options{.walks = static_cast<std::uint64_t>(walks), .seed = seed, .estimator = estimator};
    const double unit = 1 / (problem.sigma_a + (1 - problem.g) * problem.sigma_s);
    for (int i = 0; i <= 20; ++i) options.edges_mm.push_back(0.25 * i * unit);
    Observer observer;
    const HalfSpaceResult r = walkHalfSpace(problem, options, observer);
    Found found;
    for (const HalfSpaceTally* tally : {&r.all, &r.single, &r.multiple}) {
        found.add(tally->total);
        found.add(tally->mean_x_mm);
        found.add(tally->mean_r2_mm2);
        found.add(tally->Rd, tally->standard_error);
    }
    return found;
}

Found slab(const SlabProblem& problem, SlabEstimator estimator, double walks, std::uint64_t seed) {
    SlabOptions options{.walks = static_cast<std::uint64_t>(walks), .seed = seed, .depths = 20, .depth_mm = 2};
    options.angles = 9;
    options.estimator = estimator;
    for (int i = 0; i <= 20; ++i) options.edges_mm.push_back(0.2 * i);
    Observer observer;
    const SlabResult r = walkSlab(problem, options, observer);
    Found found;
    for (const Estimate& e : {r.R, r.R_single, r.T, r.A}) found.add(e);
    for (const Estimate& e : r.A_layer) found.add(e);
    for (const SlabSeries* series : {&r.R_r, &r.T_r, &r.R_a, &r.T_a, &r.A_z})
        found.add(series->mean, series->standard_error);
    return found;
}

template <class Body>
Found exitance(const Body& body, const Medium& medium, const Illumination& light, double walks, std::uint64_t seed) {
    Observer observer;
    const BodyResult r =
        walkBody(body, medium, 0, light, {.walks = static_cast<std::uint64_t>(walks), .seed = seed}, observer);
    Found found;
    for (const Estimate& e : {r.incident, r.reflectance, r.absorbed, r.collisions_per_entry, r.mean_exit[0]})
        found.add(e);
    found.add(r.exitance, r.standard_error);
    return found;
}

template <class Body>
Found radiance(const Body& body, const Medium& medium, const Illumination& light, double walks, std::uint64_t seed) {
    constexpr int pixels = 8;
    CameraRays camera{pixels, pixels, {0, 0, 20}, {}, {3.0 / pixels, 0, 0}, {0, -3.0 / pixels, 0}};
    camera.corner = Vec3{0, 0, -20} - (0.5 * pixels) * (camera.right + camera.down);
    Observer observer;
    const BodyRadiance r = walkRadiance(
        body, medium, 0, light, camera,
        {.walks_per_pixel = static_cast<std::uint64_t>(std::ceil(walks / pixels / pixels)), .seed = seed}, observer);
    // Pixels are too dim to be judged one by one.
    double sum = 0, square = 0;
    for (std::size_t i = 0; i < r.radiance.size(); ++i) {
        sum += r.radiance[i];
        square += r.standard_error[i] * r.standard_error[i];
    }
    Found found;
    found.add(Estimate{sum, std::sqrt(square), 0});
    found.mean.insert(found.mean.end(), r.radiance.begin(), r.radiance.end());
    return found;
}

struct Case {
    const char* name;
    double walks;
    std::function<Found(double walks, std::uint64_t seed)> walk;
};

// Media, boundaries and phase functions that take each way through the vector code.
std::vector<Case> halfSpaces() {
    std::vector<Case> cases;
    const auto add = [&](const char* name, const HalfSpaceProblem& problem, double walks) {
        for (const Estimator estimator : {Estimator::analogue, Estimator::best})
            cases.push_back({name, walks, [=](double count, std::uint64_t seed) {
                                 return halfSpace(problem, estimator, count, seed);
                             }});
    };
    add("isotropic", {.sigma_a = 0.05, .sigma_s = 0.95, .eta = 1.3}, 3e4);
    add("absorbing", {.sigma_a = 1, .sigma_s = 1, .eta = 1.5}, 5e4);
    add("matched, oblique", {.sigma_a = 0.1, .sigma_s = 0.9, .g = 0.4, .angle_deg = 60}, 3e4);
    add("sharp", {.sigma_a = 0.1, .sigma_s = 5, .g = 0.9, .eta = 1.4}, 2e4);
    add("thinner", {.sigma_a = 0.1, .sigma_s = 0.9, .g = -0.3, .eta = 0.8, .angle_deg = 30}, 3e4);
    return cases;
}

std::vector<Case> slabs() {
    std::vector<Case> cases;
    const auto add = [&](const char* name, const SlabProblem& problem, double walks) {
        for (const SlabEstimator estimator : {SlabEstimator::analogue, SlabEstimator::best})
            cases.push_back(
                {name, walks, [=](double count, std::uint64_t seed) { return slab(problem, estimator, count, seed); }});
    };
    constexpr double infinity = std::numeric_limits<double>::infinity();
    SlabLayer rayleigh{1.3, 0.1, 2, 0, 1};
    rayleigh.phase = rayleighPhase();
    add("sheet", {1, 1, {{1.4, 0.05, 2, 0.3, 1}}}, 2e4);
    add("two layers, oblique", {1, 1.3, {{1.4, 0.1, 4, 0.8, 0.5}, {1.33, 0.05, 2, 0, 1.5}}, 40}, 2e4);
    add("under glass", {1, 1, {{1.5, 0, 0, 0, 1}, {1.4, 0.1, 3, 0.7, 1}}}, 2e4);
    add("on an infinite layer", {1, 1, {{1.4, 0.1, 2, 0.5, 0.5}, {1.4, 0.2, 1, 0, infinity}}}, 2e4);
    add("rayleigh", {1, 1, {rayleigh}}, 2e4);
    return cases;
}

// Their lights outlive the walks.
class Bodies {
public:
    Bodies() : scene_(sunny()), sun_(scene_, placeObject(scene_)) {
        const auto add = [&](const char* name, const auto& body, const Medium& medium, const Illumination& light,
                             bool seen) {
            cases.push_back({name, 2e4, [=, &body](double count, std::uint64_t seed) {
                                 return seen ? radiance(body, medium, light, count, seed)
                                             : exitance(body, medium, light, count, seed);
                             }});
        };
        const Medium refractive = channelMedium(0.1, 8, 0.5, 1.3), matched = channelMedium(0.2, 4),
                     sharp = channelMedium(0.1, 10, 0.9, 1.4);
        for (const bool seen : {false, true}) {
            add(seen ? "ball, seen" : "ball", ball_, refractive, UniformLight{}, seen);
            add(seen ? "round mesh, seen" : "round mesh", round_, refractive, UniformLight{}, seen);
            add(seen ? "box, seen" : "box", box_, sharp, UniformLight{}, seen);
            add(seen ? "matched box in the sun, seen" : "matched box in the sun", box_, matched, &sun_, seen);
            add(seen ? "ball in the sun, seen" : "ball in the sun", ball_, refractive, &sun_, seen);
            add(seen ? "box in the sun, seen" : "box in the sun", box_, refractive, &sun_, seen);
        }
        add("pencil on a ball", ball_, refractive, PencilLight{}, false);
    }

    std::vector<Case> cases;

private:
    static Scene sunny() {
        Scene scene;
        scene.object = "sphere";
        scene.lights = {DirectionalLight{.direction = {1, 2, 3}}};
        return scene;
    }

    Scene scene_;
    LightSampler sun_;
    Ball ball_{1, 0.5};
    MeshBody round_{sphereMesh(1, 3), {.cell_area_mm2 = 0.5, .shortest_mfp = 0.1}};
    MeshBody box_{boxMesh({1, 0.6, 0.8}), {.cell_area_mm2 = 0.5, .shortest_mfp = 0.1}};
};

void expectBitForBit(const std::vector<Case>& cases) {
    for (const Case& one : cases)
        EXPECT_TRUE(on(HWY_AVX3, one.walk, one.walks, 1) == on(HWY_AVX2, one.walk, one.walks, 1)) << one.name;
}

void expectStatistically(const std::vector<Case>& cases, std::int64_t target, double part) {
    Judge judge;
    std::uint64_t seed = 500;
    for (const Case& one : cases) {
        const Found a = one.walk(one.walks, seed), b = on(target, one.walk, part * one.walks, seed + 1);
        seed += 2;
        ASSERT_EQ(a.error.size(), b.error.size());
        for (std::size_t i = 0; i < a.error.size(); ++i) {
            if (!(a.mean[i] != 0 && b.mean[i] != 0)) continue;
            const std::string what = fmt::format("{}, number {}", one.name, i);
            const double error = std::hypot(a.error[i], b.error[i]);
            // What comes from quadrature is the same but for rounding.
            if (!(error > 1e-6 * std::abs(a.mean[i])))
                EXPECT_NEAR(b.mean[i], a.mean[i], 1e-5 * std::abs(a.mean[i])) << what;
            else  // few heavy walks are far from normal
                judge.compare(what, {b.mean[i], error, 0}, a.mean[i], std::pow(b.mean[i] / b.error[i], 2));
        }
    }
    judge.expectAgreement();
}

TEST(InstructionSets, HalfSpacesAgreeBitForBitWithFma) {
    if (!hasInstructionSet(HWY_AVX3)) GTEST_SKIP() << "no AVX-512 here";
    expectBitForBit(halfSpaces());
}

TEST(InstructionSets, SlabsAgreeBitForBitWithFma) {
    if (!hasInstructionSet(HWY_AVX3)) GTEST_SKIP() << "no AVX-512 here";
    expectBitForBit(slabs());
}

TEST(InstructionSets, BodiesAgreeBitForBitWithFma) {
    if (!hasInstructionSet(HWY_AVX3)) GTEST_SKIP() << "no AVX-512 here";
    expectBitForBit(Bodies().cases);
}

TEST(InstructionSets, HalfSpacesAgreeStatisticallyWithoutFma) {
    if (hasInstructionSet(HWY_SSE4)) expectStatistically(halfSpaces(), HWY_SSE4, 1);
    expectStatistically(halfSpaces(), HWY_EMU128, 0.1);
}

TEST(InstructionSets, SlabsAgreeStatisticallyWithoutFma) {
    if (hasInstructionSet(HWY_SSE4)) expectStatistically(slabs(), HWY_SSE4, 1);
    expectStatistically(slabs(), HWY_EMU128, 0.1);
}

TEST(InstructionSets, BodiesAgreeStatisticallyWithoutFma) {
    if (hasInstructionSet(HWY_SSE4)) expectStatistically(Bodies().cases, HWY_SSE4, 1);
    expectStatistically(Bodies().cases, HWY_EMU128, 0.1);
}

}  // namespace
}  // namespace searchlight
