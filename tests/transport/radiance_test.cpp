#include "transport/half_space/radiance.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/error.h"
#include "exact.h"
#include "judge.h"

namespace searchlight {
namespace {

constexpr double pi = std::numbers::pi;

RadianceResult radiance(const HalfSpaceProblem& problem, const RadianceOptions& options) {
    Observer observer;
    return walkRadiance(problem, options, observer);
}

double sine2(double angle_deg) { return std::pow(std::sin(angle_deg * pi / 180), 2); }

// What the hemisphere adds up to: the integral of radiance times cosine.
double hemisphereSum(const RadianceResult& result, const RadianceOptions& options) {
    double sum = 0;
    for (int i = 0; i < options.polar; ++i) {
        const double projected =
            (sine2(90.0 * (i + 1) / options.polar) - sine2(90.0 * i / options.polar)) * pi / options.turns;
        for (int j = 0; j < options.turns; ++j)
            sum += result.radiance[static_cast<std::size_t>(i * options.turns + j)] * projected;
    }
    return sum;
}

TEST(Radiance, OfAllDirectionsSumsToTheExitanceOfTheSector) {
    const RadianceOptions options{
        .walks = 200'000, .r0_mm = 0.5, .r1_mm = 1, .azimuth_deg = 40, .half_width_deg = 15, .polar = 5, .turns = 7};
    for (const double eta : {1.0, 1.4, 0.8}) {
        const HalfSpaceProblem problem{.sigma_a = 0.1, .sigma_s = 2, .g = 0.5, .eta = eta, .angle_deg = 50};
        const RadianceResult result = radiance(problem, options);
        EXPECT_GT(result.exitance.mean, 0);
        // The same counts, summed in another order.
        EXPECT_NEAR(hemisphereSum(result, options), result.exitance.mean, 1e-12 * result.exitance.mean);
    }
}

TEST(Radiance, OfTheWholeAnnulusIsTheProfileOfTheSameWalks) {
    const HalfSpaceProblem problem{.sigma_a = 0.05, .sigma_s = 1, .g = 0.3, .eta = 1.3, .angle_deg = 60};
    const HalfSpaceResult profile = walk(problem, 200'000, 3, {0, 0.5, 1.5});
    const RadianceResult result =
        radiance(problem, {.walks = 200'000, .seed = 3, .r0_mm = 0.5, .r1_mm = 1.5, .half_width_deg = 180, .polar = 2});
    EXPECT_EQ(result.specular, profile.specular);
    // Radii in float, squared in double on one side and divided into bins on the other: a walk may change sides.
    EXPECT_NEAR(result.exitance.mean, profile.all.Rd[1], 1e-4 * profile.all.Rd[1]);
    EXPECT_NEAR(result.exitance.standard_error, profile.all.standard_error[1], 0.01 * profile.all.standard_error[1]);
}

// Chandrasekhar's H by iteration on 64 midpoints in angle: 1e-4 of H.
std::vector<double> hFunction(double albedo, const std::vector<double>& mu, const std::vector<double>& weight) {
    std::vector<double> h(mu.size(), 1.0);
    for (int step = 0; step < 400; ++step) {
        std::vector<double> next;
        for (const double m : mu) {
            double integral = 0;
            for (std::size_t k = 0; k < mu.size(); ++k) integral += weight[k] * mu[k] * h[k] / (m + mu[k]);
            next.push_back(1 / (std::sqrt(1 - albedo) + 0.5 * albedo * integral));
        }
        h = next;
    }
    return h;
}

// Integrated over the surface a pencil beam is a wide one: [Chandrasekhar1960] section 33,
// I(mu) = albedo H(mu) H(mu0) / (4 pi (mu + mu0)) per unit incident flux.
TEST(Radiance, OfTheWholePlaneFollowsChandrasekharsLaw) {
    constexpr int polar = 9, points = 900;
    std::vector<double> mu, weight;
    for (int i = 0; i < points; ++i) {
        const double angle = 0.5 * pi * (i + 0.5) / points;
        mu.push_back(std::cos(angle));
        weight.push_back(std::sin(angle) * 0.5 * pi / points);
    }
    Judge judge;
    std::uint64_t seed = 11;
    for (const double albedo : {0.5, 0.95})
        for (const std::size_t entry : {std::size_t{0}, std::size_t{600}}) {  // 0.05 and 60.05 degrees
            const std::vector<double> h = hFunction(albedo, mu, weight);
            HalfSpaceProblem problem = ofAlbedo(albedo);
            problem.angle_deg = std::acos(mu[entry]) * 180 / pi;
            constexpr double r1 = 300;  // mean free paths: exp(-0.37 * 300) is left beyond
            const RadianceOptions options{
                .walks = 400'000, .seed = seed++, .r1_mm = r1, .half_width_deg = 180, .polar = polar, .turns = 4};
            const RadianceResult result = radiance(problem, options);
            for (int i = 0; i < polar; ++i) {
                double mean = 0, projected = 0;
                for (int k = i * points / polar; k < (i + 1) * points / polar; ++k) {
                    const auto at = static_cast<std::size_t>(k);
                    mean += weight[at] * mu[at] * albedo * h[at] * h[entry] / (4 * pi * (mu[at] + mu[entry]));
                    projected += weight[at] * mu[at];
                }
                for (int j = 0; j < 4; ++j) {
                    const auto cell = static_cast<std::size_t>(4 * i + j);
                    const double area = pi * r1 * r1;
                    // Isotropic scattering knows no azimuth; mirror images make two cells of four one number.
                    if (j < 2)
                        judge.compare("albedo, entry, cell " + std::to_string(albedo) + " " + std::to_string(entry) +
                                          " " + std::to_string(i),
                                      {area * result.radiance[cell], area * result.standard_error[cell]},
                                      mean / projected);
                }
            }
        }
    judge.expectAgreement();
}

// Integrated over the plane it is a BRDF, which is reciprocal. The beam stands at the cosine-weighted middle of the
// cell that it is exchanged with; what remains of the curvature within 10 degrees is below 1 %.
TEST(Radiance, IsReciprocalUnderARefractingBoundary) {
    const RadianceOptions options{.walks = 1'500'000, .r1_mm = 200, .half_width_deg = 180, .polar = 9, .turns = 1};
    for (const double eta : {1.0, 1.5}) {
        HalfSpaceProblem problem = ofAlbedo(0.9, eta);
        problem.angle_deg = 6.7;
        const RadianceResult steep = radiance(problem, options);
        problem.angle_deg = 54.9;
        const RadianceResult flat = radiance(problem, options);
        const double error = std::hypot(steep.standard_error[5], flat.standard_error[0]);
        EXPECT_NEAR(steep.radiance[5], flat.radiance[0], 4 * error + 0.01 * steep.radiance[5]) << eta;
        EXPECT_LT(4 * error, 0.06 * steep.radiance[5]) << "or this test sees nothing";
    }
}

TEST(Radiance, IsTheSameOnBothSidesOfThePlaneOfIncidence) {
    const HalfSpaceProblem problem{.sigma_a = 0.1, .sigma_s = 1, .g = 0.6, .eta = 1.33, .angle_deg = 60};
    const RadianceResult result =
        radiance(problem, {.walks = 100'000, .r0_mm = 0.2, .r1_mm = 1, .half_width_deg = 20, .polar = 3, .turns = 8});
    // The sector lies about the plane, so that mirrored cells hold mirrored exits.
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 4; ++j)
            EXPECT_NEAR(result.radiance[8 * i + j], result.radiance[8 * i + 7 - j], 1e-3 * result.radiance[8 * i + j]);
    // And what leaves on the far side leaves forwards.
    EXPECT_GT(result.radiance[8 * 2 + 0], 1.2 * result.radiance[8 * 2 + 3]);
}

TEST(Radiance, DoesNotDependOnThreads) {
    const HalfSpaceProblem problem{.sigma_a = 0.1, .sigma_s = 1, .g = 0.6, .eta = 1.33, .angle_deg = 60};
    RadianceOptions options{.walks = 50'000, .r1_mm = 2, .threads = 1};
    const RadianceResult one = radiance(problem, options);
    options.threads = 2;
    const RadianceResult two = radiance(problem, options);
    EXPECT_EQ(one.radiance, two.radiance);
    EXPECT_EQ(one.standard_error, two.standard_error);
    options.seed = 2;
    EXPECT_NE(one.radiance, radiance(problem, options).radiance);
}

TEST(Radiance, OfNothingIsNothing) {
    const RadianceResult result = radiance({.sigma_a = 1, .sigma_s = 0}, {.walks = 10, .polar = 2, .turns = 2});
    EXPECT_EQ(result.radiance, std::vector<double>(4, 0.0));
    EXPECT_EQ(result.exitance.mean, 0);
}

TEST(Radiance, RefusesImpossibleSectorsInWords) {
    const auto messageOf = [](const RadianceOptions& options) -> std::string {
        try {
            radiance({}, options);
        } catch (const Error& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_EQ(messageOf({.r0_mm = 2, .r1_mm = 1}),
              "an annulus from 2 to 1 mm (its radii ascend from 0 or more, up to 1e9 mm)");
    EXPECT_EQ(messageOf({.half_width_deg = 0}), "half the width of the sector is 0 deg (above 0, up to 180)");
    EXPECT_EQ(messageOf({.polar = 0}), "a hemisphere of 0 x 24 cells (at least 1 x 1, up to 65,536 cells)");
    EXPECT_EQ(messageOf({.walks = 0}), "a reference needs at least one walk");
}

}  // namespace
}  // namespace searchlight
