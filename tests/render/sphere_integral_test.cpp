#include "render/sphere/sphere_integral.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/random.h"
#include "geometry/object.h"
#include "model/physics.h"
#include "render/sphere/directions.h"
#include "render/sphere/sphere_reference.h"
#include "transport/judge.h"

namespace searchlight {
namespace {

constexpr double pi = std::numbers::pi;

struct Lit {
    Scene scene;
    Object object;
    LightSampler lights;

    explicit Lit(double radius_mm, std::vector<Light> light = {DirectionalLight{.direction = {0.3, 1, 0.5}}})
        : scene{.object = "sphere", .scale = 2 * radius_mm, .lights = std::move(light)},
          object(placeObject(scene)),
          lights(scene, object) {}
};

Medium mediumOf(double sigma_a, double sigma_s, double eta, double g = 0) {
    Medium medium;
    medium.sigma_a = {sigma_a, 2 * sigma_a, 3 * sigma_a};
    medium.sigma_s = {sigma_s, 0.7 * sigma_s, 0.5 * sigma_s};
    medium.g = {g, g, g};
    medium.eta = eta;
    return medium;
}

// R_d as a table: what the model is, and its integral, are then known exactly.
Model tableModel(std::vector<double> radii, std::vector<Rgb> values) {
    Model model;
    model.id = "table";
    model.measured = true;
    model.file.radial = model.file.no_wi = model.file.no_wo = true;
    model.profile = Profile(std::move(radii), std::move(values));
    return model;
}

// Through a sphere's shadow disc goes pi R^2 of flux per unit of irradiance, of which the mean transmittance of uniform
// light crosses: rays of a beam meet a sphere at all angles like those of uniform light meet a plane.
double crossingFlux(double radius, double eta) {
    return pi * radius * radius * (1 - 2 * Physics<double>::fresnelMoment(1, 1 / eta));
}

// The surface of a sphere within a chord r is pi r^2, so what a radial model gives back of the flux that crosses is
// its profile's encircled flux at the diameter, wherever the light comes from.
TEST(SphereIntegral, GivesBackTheEncircledFluxOfARadialModel) {
    Judge judge;
    for (const double eta : {1.0, 1.4})
        for (const double width : {0.05, 1.0, 20.0}) {
            std::vector<double> radii;
            std::vector<Rgb> values;
            for (int i = 0; i <= 60; ++i) {
                const double r = 0.1 * i * width;
                radii.push_back(r);
                values.push_back({std::exp(-r / width), 0.5 * std::exp(-2 * r / width), 1 / (1 + r * r)});
            }
            const Model model = tableModel(radii, values);
            const Medium medium = mediumOf(0.1, 1, eta);
            const auto evaluator = makeMeasuredEvaluator(model);
            evaluator->set(medium, {});
            const Ball ball(3, 1);
            const Lit lit(3);
            SphereIntegral integral(ball, lit.lights, model, *evaluator, medium, {});
            Observer observer;
            integral.add(200, observer);
            for (int c = 0; c < Rgb::channels; ++c)
                judge.compare("eta " + std::to_string(eta) + ", width " + std::to_string(width),
                              integral.left()[static_cast<std::size_t>(c)],
                              crossingFlux(3, eta) * model.profile.encircled(6)[c]);
        }
    judge.expectAgreement();
}

// A profile that is the same everywhere mixes all light: exitance is one number.
TEST(SphereIntegral, OfAConstantProfileIsTheSameInEveryCell) {
    const Model model = tableModel({0, 5, 10}, {{1, 2, 3}, {1, 2, 3}, {1, 2, 3}});
    const Medium medium = mediumOf(0.1, 1, 1.3);
    const auto evaluator = makeMeasuredEvaluator(model);
    evaluator->set(medium, {});
    const Ball ball(2, 0.5);
    const Lit lit(2);
    SphereIntegral integral(ball, lit.lights, model, *evaluator, medium, {});
    Observer observer;
    integral.add(400, observer);
    const SphereExitance exitance = integral.exitance();
    Judge judge;
    for (std::size_t cell = 0; cell < ball.cellCount(); ++cell)
        judge.compare("cell " + std::to_string(cell), {exitance.mean[1][cell], exitance.standard_error[1][cell], 400},
                      2 * crossingFlux(2, 1.3));
    judge.expectAgreement();
}

// The same integral with entries spread evenly and nothing else: slow, but with no sampling that could be wrong.
SphereExitance plainSum(const Ball& ball, const LightSampler& lights, Evaluator& evaluator, const Medium& medium,
                        const std::vector<std::uint32_t>& cells, int samples, std::uint64_t seed) {
    SphereExitance sum;
    for (auto& mean : sum.mean) mean.assign(ball.cellCount(), 0.0);
    sum.standard_error = sum.mean;
    const double normalizer = 1 - 2 * Physics<double>::fresnelMoment(1, 1 / medium.eta);
    for (const std::uint32_t cell : cells) {
        SplitMix64 random = streamOf(seed, cell);
        std::vector<Query> queries;
        std::vector<Rgb> weights, values;
        for (int i = 0; i < samples; ++i) {
            const double a = random.uniform(), b = random.uniform();
            const Vec3 no = directionInCell(ball.cells(), cell, a, b);
            const double z = 2 * random.uniform() - 1, turn = 2 * pi * random.uniform();
            const Vec3 ni = directionAround({0, 0, 1}, z, turn);
            const LightSample light = lights.sample(ball.radius() * ni, .5, .5, .5);
            // Any direction outside, evenly by cosine squared; weighted to the density of leaving light.
            const double mu = std::sqrt(random.uniform());
            const Vec3 wo = directionAround(no, mu, 2 * pi * random.uniform());
            const double exit = (1 - Physics<double>::fresnelReflectance(mu, 1 / medium.eta)) / normalizer;
            const double crossed = transmittedCosine(dot(light.wi, ni), medium.eta);
            weights.push_back((exit * ball.area() * crossed) * light.irradiance_over_pdf);
            queries.push_back({ball.radius() * ni, light.wi, ni, ball.radius() * no, wo, no});
        }
        values.resize(queries.size());
        evaluator.evaluate(queries, values);
        for (int c = 0; c < Rgb::channels; ++c) {
            double total = 0, square = 0;
            for (std::size_t i = 0; i < values.size(); ++i) {
                const double value = weights[i][c] > 0 ? weights[i][c] * values[i][c] : 0;
                total += value;
                square += value * value;
            }
            const auto at = static_cast<std::size_t>(c);
            sum.mean[at][cell] = total / samples;
            sum.standard_error[at][cell] = std::sqrt((square / samples - std::pow(total / samples, 2)) / samples);
        }
    }
    return sum;
}

// Models that read directions, and one that reads wo; mean free paths of the sphere's size, so that every part counts.
// Channels share their samples, so one channel of each model is judged.
TEST(SphereIntegral, AgreesWithEvenSamplingForDirectionalModels) {
    Judge judge;
    std::uint64_t seed = 0;
    for (const char* id : {"directional_dipole", "directional_dipole_reciprocal", "photon_beam_diffusion", "dipole"}) {
        const Model model = loadModel(id);
        const Medium medium = mediumOf(0.05, 0.8, 1.3);
        const auto evaluator = makeNativeEvaluator(model);
        evaluator->set(medium, {});
        const Ball ball(1.5, 2);
        const Lit lit(1.5);
        std::vector<std::uint32_t> cells{0, 5, 9, 12};
        SphereIntegral integral(ball, lit.lights, model, *evaluator, medium, {.cells = cells, .seed = ++seed});
        Observer observer;
        integral.add(20'000, observer);
        const SphereExitance found = integral.exitance();
        const SphereExitance plain = plainSum(ball, lit.lights, *evaluator, medium, cells, 100'000, 100 + seed);
        const std::size_t c = seed % 3;
        for (const std::uint32_t cell : cells)
            judge.compare(
                std::string(id) + ", cell " + std::to_string(cell),
                {found.mean[c][cell], std::hypot(found.standard_error[c][cell], plain.standard_error[c][cell]), 20'000},
                plain.mean[c][cell]);
    }
    judge.expectAgreement();
}

TEST(SphereIntegral, DoesNotDependOnThreadsOrOnHowItIsCut) {
    const Model model = loadModel("better_dipole");
    const Medium medium = mediumOf(0.05, 1, 1.3);
    const auto evaluator = makeNativeEvaluator(model);
    evaluator->set(medium, {});
    const Ball ball(4, 2);
    const Lit lit(4);
    Observer observer;
    SphereIntegral whole(ball, lit.lights, model, *evaluator, medium, {.threads = 1});
    whole.add(6, observer);
    SphereIntegral cut(ball, lit.lights, model, *evaluator, medium, {.threads = 2});
    cut.add(2, observer);
    cut.add(4, observer);
    EXPECT_EQ(whole.exitance().mean[0], cut.exitance().mean[0]);
    EXPECT_EQ(whole.exitance().standard_error[2], cut.exitance().standard_error[2]);
}

TEST(SphereReference, GoesOnWhereItStopped) {
    const Medium medium = mediumOf(0.2, 1, 1.3);
    const Ball ball(2, 2);
    const Lit lit(2);
    Observer observer;
    SphereReference steps(ball, lit.lights, medium);
    EXPECT_EQ(steps.walks(), 0u);
    steps.walkTo(64 * 1024, observer);
    const double first = steps.channels()[0]->reflectance.standard_error;
    steps.walkTo(4 * 64 * 1024, observer);
    EXPECT_NEAR(static_cast<double>(steps.walks()), 4 * 64 * 1024, 4000) << "walks are drawn";
    // Four times the walks, half the error; batches of 64 know their scatter to 9 %.
    EXPECT_NEAR(steps.channels()[0]->reflectance.standard_error / first, 0.5, 0.2);
    EXPECT_EQ(steps.exitance().mean[1].size(), ball.cellCount());
}

}  // namespace
}  // namespace searchlight
