#include "render/directional_sum.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "render/brute_force.h"
#include "render/directional_hierarchy.h"
#include "render/exitance_scene.h"
#include "render/hierarchical.h"

namespace searchlight {
namespace {

Vec3 dentedNormal(Vec3 unit) {
    const Vec3 t = normalize(cross(std::abs(unit.x) < 0.7 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}, unit)), b = cross(unit, t);
    const auto slope = [&](Vec3 along) {
        constexpr double h = 1e-5;
        return (0.5 / h) * (dented(normalize(unit + h * along), 1) - dented(normalize(unit - h * along), 1));
    };
    return normalize(cross(slope(t), slope(b)));
}

// A dented sphere of marble and what a technique reads of it.
struct Case {
    PointCloud points;
    Irradiance irradiance;
    VisibleSurface visible;
    Scene scene;
    Model model = loadModel("directional_dipole");
    Medium medium = findMaterial("marble").medium;
    std::unique_ptr<Evaluator> evaluator = makeNativeEvaluator(model);

    explicit Case(double radius_mm, std::size_t count = 2000, std::size_t receivers = 300) {
        evaluator->set(medium, {});
        points = dentedSphere(count, radius_mm, lambert).cloud;
        for (const Vec3 unit : spiral(count)) points.normals.push_back(toFloat(dentedNormal(unit)));
        for (const Vec3 unit : spiral(receivers)) {
            visible.positions.push_back(toFloat(dented(unit, radius_mm)));
            visible.normals.push_back(toFloat(dentedNormal(unit)));
        }
        visible.eye = {0, 0, 4 * radius_mm};
        irradiance.transmitted.assign(count, {});
    }

    /// Lighting towards `to`, or of a point there.
    void add(Vec3 to, bool parallel, Rgb colour = {1, 0.8, 0.5}) {
        Beam beam;
        if (parallel) beam.wi = {toFloat(normalize(to))};
        for (std::size_t i = 0; i < points.positions.size(); ++i) {
            const Vec3 wi = normalize(parallel ? to : to - toDouble(points.positions[i]));
            if (!parallel) beam.wi.push_back(toFloat(wi));
            const Rgb flux = std::max(0.0, dot(wi, toDouble(points.normals[i]))) * colour;
            beam.flux.push_back(toFloat(flux));
            irradiance.transmitted[i] = toFloat(toDouble(irradiance.transmitted[i]) + flux);
        }
        irradiance.beams.push_back(std::move(beam));
    }

    RenderInput input(int threads = 0) const {
        RenderInput input;
        input.scene = &scene;
        input.points = &points;
        input.irradiance = &irradiance;
        input.visible = &visible;
        input.model = &model;
        input.evaluator = evaluator.get();
        input.medium = &medium;
        input.threads = threads;
        input.versions = {1, 1, 1, 1};
        return input;
    }
};

std::vector<Rgbf> run(Technique& technique, const RenderInput& input, double error) {
    Observer observer;
    technique.start(input, {{"error", error}}, observer);
    while (!technique.step(observer)) {
    }
    return {technique.exitance().begin(), technique.exitance().end()};
}

std::vector<Rgb> bruteForce(const RenderInput& input) {
    const auto technique = makeBruteForce(nullptr);
    std::vector<Rgb> sums;
    for (const Rgbf& value : run(*technique, input, 0)) sums.push_back(toDouble(value));
    return sums;
}

enum class Lighting { parallel, point, surroundings };

Case litCase(double radius_mm, Lighting light) {
    Case lit(radius_mm);
    if (light == Lighting::parallel) lit.add({1, 1, 1}, true);
    if (light == Lighting::point) lit.add({0, 0.4 * radius_mm, 1.6 * radius_mm}, false);
    if (light == Lighting::surroundings)
        for (const Vec3 unit : spiral(16)) lit.add(unit, true, {1 + unit.z, 1, 1 - unit.x});
    return lit;
}

TEST(DirectionalSum, KeepsTheErrorThatWasAskedForInEveryLight) {
    for (const Lighting light : {Lighting::parallel, Lighting::point, Lighting::surroundings}) {
        const Case lit = litCase(15, light);
        const std::vector<Rgb> exact = bruteForce(lit.input());
        for (const double error : {0.01, 0.05}) {
            const auto technique = makeDirectionalHierarchy();
            const SumError found = errorOf(run(*technique, lit.input(), error), exact);
            const TechniqueReport report = technique->report();
            EXPECT_LE(found.rmse, report.error_bound) << static_cast<int>(light);
            EXPECT_LE(report.error_bound, error);
            // Of all points that a receiver has, under every beam.
            const double terms = 300.0 * 2000 * static_cast<double>(lit.irradiance.beams.size());
            EXPECT_LT(static_cast<double>(report.interactions), (error < 0.02 ? 0.35 : 0.15) * terms);
        }
    }
}

TEST(DirectionalSum, DoesNotDependOnThreads) {
    const Case lit = litCase(15, Lighting::parallel);
    const std::vector<Rgbf> one = run(*makeDirectionalHierarchy(), lit.input(1), 0.02);
    EXPECT_EQ(run(*makeDirectionalHierarchy(), lit.input(2), 0.02), one);
    EXPECT_EQ(run(*makeDirectionalHierarchy(), lit.input(5), 0.02), one);
}

// All groups of receivers, in the receivers' order.
std::vector<Rgbf> sumAll(DirectionalSum& sum, double opening, std::uint64_t& evaluations) {
    std::vector<DirectionalSum::Part> parts;
    for (std::size_t k = 0; k < sum.groups(); ++k) parts.push_back({k, sum.firstOf(k), sum.firstOf(k + 1)});
    const DirectionalSum::Result result = sum.sum(parts, opening);
    evaluations = result.evaluations;
    std::vector<Rgbf> values(result.exitance.size());
    for (std::size_t i = 0; i < values.size(); ++i) values[sum.order()[i]] = toFloat(result.exitance[i]);
    return values;
}

DirectionalSum sumOf(const Case& lit) {
    DirectionalSum sum(0);
    sum.setPoints(lit.points);
    sum.setModel(lit.model, lit.medium, {}, *lit.evaluator);
    sum.setLight(lit.irradiance, !lit.model.file.no_wi);
    sum.setReceivers(lit.visible);
    return sum;
}

TEST(DirectionalSum, WithoutOpeningItIsTheFullSum) {
    const Case lit = litCase(15, Lighting::point);
    DirectionalSum sum = sumOf(lit);
    std::uint64_t evaluations = 0;
    const std::vector<Rgbf> found = sumAll(sum, 0, evaluations);
    // Rounding to floats, and another order of 2,000 terms in double.
    EXPECT_LT(errorOf(found, bruteForce(lit.input())).largest, 1e-6);
    const auto lit_points =
        std::ranges::count_if(lit.irradiance.beams[0].flux, [](const Rgbf& flux) { return flux != Rgbf{}; });
    EXPECT_EQ(evaluations, 300u * static_cast<std::uint64_t>(lit_points));
}

// The pilot would hide a wrong term by opening more nodes; the order of the error does not.
TEST(DirectionalSum, ErrorOfATermIsOfThirdOrder) {
    // A smooth model: the directional dipole jumps where the refracted ray leaves the receiver's half-space.
    Case lit(15, 20'000, 300);
    lit.model = loadModel("dipole");
    lit.evaluator = makeNativeEvaluator(lit.model);
    lit.evaluator->set(lit.medium, {});
    lit.add({1, 1, 1}, true);
    const std::vector<Rgb> exact = bruteForce(lit.input());
    DirectionalSum sum = sumOf(lit);
    std::uint64_t few = 0, many = 0;
    const double coarse = errorOf(sumAll(sum, 0.008, few), exact).rmse;
    const double fine = errorOf(sumAll(sum, 0.001, many), exact).rmse;
    // Half the reach makes an eighth of the error of a term: six times less here, with the rule by distance. Offsets
    // that are 5 % short leave 4.3.
    EXPECT_LT(fine, coarse / 5);
    EXPECT_LT(few, many);
}

// A plate of two sheets: nodes of both have normals that cancel.
TEST(DirectionalSum, OpensNodesWhoseNormalsCancel) {
    Case plate(10, 800, 64);
    for (std::size_t i = 0; i < 800; ++i) {
        const float side = i % 2 == 0 ? 1.0f : -1.0f;
        const auto x = static_cast<float>(i / 2 % 20), y = static_cast<float>(i / 40);
        plate.points.positions[i] = {x, y, 0.05f * side};
        plate.points.normals[i] = {0.28f, 0, 0.96f * side};
        plate.points.areas[i] = 1;
    }
    for (std::size_t i = 0; i < 64; ++i) {
        plate.visible.positions[i] = {static_cast<float>(i), 10, 0.05f};
        plate.visible.normals[i] = {0, 0, 1};
    }
    plate.add({1, 0, 0}, true);  // grazes both
    DirectionalSum sum = sumOf(plate);
    std::uint64_t evaluations = 0;
    // However wide the nodes are opened, those that hold both sheets are not taken.
    EXPECT_LE(errorOf(sumAll(sum, 1, evaluations), bruteForce(plate.input())).rmse, 0.01);
}

TEST(DirectionalSum, FindsTheLightOfOnePoint) {
    Case lit(15);
    lit.add({1, 1, 1}, true);
    for (std::size_t i = 0; i < 2000; ++i)
        if (i != 700) lit.irradiance.beams[0].flux[i] = {};
    lit.irradiance.beams[0].flux[700] = {1, 1, 1};
    const SumError found = errorOf(run(*makeDirectionalHierarchy(), lit.input(), 0.05), bruteForce(lit.input()));
    EXPECT_LE(found.rmse, 0.05);
}

TEST(DirectionalSum, NothingIsSeenOfNothingAndDarknessIsDark) {
    Case dark(10, 100, 20);
    dark.add({0, 0, 1}, true, {});
    for (const Rgbf& value : run(*makeDirectionalHierarchy(), dark.input(), 0.01)) EXPECT_EQ(value, Rgbf{});
    dark.visible.positions.clear();
    EXPECT_TRUE(run(*makeDirectionalHierarchy(), dark.input(), 0.01).empty());
}

TEST(DirectionalSum, WhatChangesIsTakenOver) {
    Case lit = litCase(15, Lighting::parallel);
    const auto technique = makeHierarchical(nullptr);
    RenderInput input = lit.input();
    run(*technique, input, 0.02);
    lit.add({-1, 0, 0}, true);
    ++input.versions.light;
    EXPECT_LE(errorOf(run(*technique, input, 0.02), bruteForce(input)).rmse, 0.02);
    // A radial model in between, which is summed by its profile.
    const Profile profile = dipoleProfile("marble");
    input.profile = &profile;
    ++input.versions.material;
    EXPECT_LE(errorOf(run(*technique, input, 0.02), bruteForce(input)).rmse, 0.02);
    input.profile = nullptr;
    lit.medium.sigma_a = 3 * lit.medium.sigma_a;
    lit.evaluator->set(lit.medium, {});
    ++input.versions.material;
    EXPECT_LE(errorOf(run(*technique, input, 0.02), bruteForce(input)).rmse, 0.02);
}

TEST(DirectionalSum, CancellingInterrupts) {
    struct Cancelled final : Observer {
        bool cancelled() const override { return true; }
    } observer;
    const Case lit = litCase(15, Lighting::parallel);
    const auto technique = makeDirectionalHierarchy();
    technique->start(lit.input(), {{"error", 0.01}}, observer);
    EXPECT_THROW(technique->step(observer), Error);
}

}  // namespace
}  // namespace searchlight
