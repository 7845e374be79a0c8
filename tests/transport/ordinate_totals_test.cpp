// Totals and angles of slabs without noise: clear layers, oblique beams.
#include "transport/exact/ordinate_totals.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "base/error.h"
#include "exact.h"
#include "transport/exact/exact_half_space.h"
#include "transport/exact/ordinate_scattering.h"
#include "transport/walk/fresnel.h"

namespace searchlight {
namespace {

using std::numbers::pi;
using testing::HasSubstr;

constexpr double infinity = std::numeric_limits<double>::infinity();

double cosine(double angle_deg) { return std::cos(angle_deg * pi / 180); }

double sumOf(const SlabResult& r) {
    return r.specular + r.R.mean + r.R_unscattered.mean + r.T.mean + r.T_unscattered.mean + r.A.mean;
}

// Flux in all angles.
double hemisphere(const SlabSeries& series) {
    const double step = 0.5 * pi / static_cast<double>(series.mean.size());
    double sum = 0;
    for (std::size_t i = 0; i < series.mean.size(); ++i)
        sum += series.mean[i] * 4 * pi * std::sin(0.5 * step) * std::sin((static_cast<double>(i) + 0.5) * step);
    return sum;
}

// A plate that absorbs, between unlike media, by the geometric series of its two surfaces.
TEST(OrdinateTotals, APlateFollowsFresnelAndBeer) {
    for (const double angle_deg : {0.0, 40.0, 75.0}) {
        const double n = 1.5, below = 1.2, sigma_a = 0.3, thickness = 2;
        const double sine = std::sin(angle_deg * pi / 180), inside = std::sqrt(1 - sine * sine / (n * n)),
                     beyond = std::sqrt(1 - sine * sine / (below * below));
        const double top = fresnelReflectance(1, cosine(angle_deg), n, inside),
                     bottom = fresnelReflectance(n, inside, below, beyond);
        const double passes = std::exp(-sigma_a * thickness / inside), round = top * bottom * passes * passes;
        const SlabResult r = solveSlabTotals({1, below, {{n, sigma_a, 0, 0, thickness}}, angle_deg});
        EXPECT_NEAR(r.specular, top, 1e-14);
        EXPECT_NEAR(r.R_unscattered.mean, (1 - top) * (1 - top) * bottom * passes * passes / (1 - round), 1e-13);
        EXPECT_NEAR(r.T_unscattered.mean, (1 - top) * (1 - bottom) * passes / (1 - round), 1e-13);
        EXPECT_EQ(r.R.mean, 0);
        EXPECT_NEAR(sumOf(r), 1, 1e-13) << angle_deg;
        // Without absorption all of it is called specular.
        const SlabResult clear = solveSlabTotals({1, below, {{n, 0, 0, 0, thickness}}, angle_deg});
        EXPECT_NEAR(clear.specular, top + (1 - top) * (1 - top) * bottom / (1 - top * bottom), 1e-14);
        EXPECT_NEAR(sumOf(clear), 1, 1e-14);
    }
}

// [Chandrasekhar1960]: total and radiance of the half-space by its H function.
TEST(OrdinateTotals, ObliqueBeamsMatchTheHFunction) {
    for (const double albedo : {0.3, 0.9, 0.99})
        for (const double angle_deg : {0.0, 40.0, 60.0, 80.0}) {
            const double mu0 = cosine(angle_deg);
            const SlabResult r = solveSlabTotals({1, 1, {{1, 1 - albedo, albedo, 0, infinity}}, angle_deg}, 9);
            const double truth = exactTotal(1 - albedo, albedo, mu0).all.mean;
            EXPECT_NEAR(r.R.mean, truth, 2e-6) << albedo << " " << angle_deg;
            EXPECT_NEAR(sumOf(r), 1, 1e-9);
            EXPECT_NEAR(hemisphere(r.R_a), r.R.mean, 1e-5 * r.R.mean);
            const auto H = [&](double mu) {
                return (1 - exactTotal(1 - albedo, albedo, mu).all.mean) / std::sqrt(1 - albedo);
            };
            const GaussRule rule = gaussRule(16);
            for (std::size_t i = 0; i < 9; ++i) {
                const double high = std::cos(static_cast<double>(i) * pi / 18),
                             low = std::cos(static_cast<double>(i + 1) * pi / 18);
                double mean = 0;
                for (std::size_t k = 0; k < rule.x.size(); ++k) {
                    const double mu = low + (high - low) * rule.x[k];
                    mean += rule.weight[k] * albedo * H(mu) * H(mu0) * mu / (4 * pi * (mu + mu0));
                }
                EXPECT_NEAR(r.R_a.mean[i], mean, 1e-4 * mean) << albedo << " " << angle_deg << " " << i;
                EXPECT_LE(std::abs(r.R_a.mean[i] - mean), r.R_a.standard_error[i] + 1e-9);
            }
        }
}

// Glass of the index of what is beyond it bends nothing anew.
TEST(OrdinateTotals, ClearLayersOfTheIndexBeyondChangeNothing) {
    const SlabLayer layer{1.4, 0.05, 2, 0.6, 1};
    for (const double angle_deg : {0.0, 50.0}) {
        const SlabResult bare = solveSlabTotals({1, 1.3, {layer}, angle_deg});
        for (const std::vector<SlabLayer>& layers :
             {std::vector<SlabLayer>{{1, 0, 0, 0, 3}, layer, {1.3, 0, 0, 0, 2}},
              std::vector<SlabLayer>{layer, {1.4, 0, 0, 0, 2}}, std::vector<SlabLayer>{{1.4, 0, 0, 0, 2}, layer}}) {
            const SlabResult r = solveSlabTotals({1, 1.3, layers, angle_deg});
            EXPECT_NEAR(r.specular, bare.specular, 1e-14);
            EXPECT_NEAR(r.R.mean, bare.R.mean, 1e-10);
            EXPECT_NEAR(r.T.mean, bare.T.mean, 1e-10);
            EXPECT_NEAR(r.T_unscattered.mean, bare.T_unscattered.mean, 1e-12);
            EXPECT_NEAR(r.A.mean, bare.A.mean, 1e-10);
            for (std::size_t i = 0; i < r.R_a.mean.size(); ++i) {
                EXPECT_NEAR(r.R_a.mean[i], bare.R_a.mean[i], 1e-10);
                EXPECT_NEAR(r.T_a.mean[i], bare.T_a.mean[i], 1e-10);
            }
        }
    }
}

// Few directions fit between critical angles that are close; what is not absorbed leaves all the same.
TEST(OrdinateTotals, CloseIndicesLoseNoLight) {
    for (const double part : {0.001, 0.003, 0.01, 0.02})
        for (const double angle_deg : {0.0, 40.0}) {
            const double n = 1.36, above = n * (1 + part);
            for (const SlabProblem& problem :
                 {SlabProblem{1, 1, {{n, 0, 3, 0.6, 1}, {above, 0, 1, 0, 2}}, angle_deg},
                  SlabProblem{1, above, {{above, 0, 2, 0.8, 1}, {n, 0, 1, 0.3, 2}, {1, 0, 1, 0, 1}}, angle_deg},
                  SlabProblem{1, 1 + part, {{n, 0, 3, 0.6, 1}, {1 + 2 * part, 0, 1, 0, 2}}, angle_deg}}) {
                const SlabResult r = solveSlabTotals(problem);
                EXPECT_NEAR(sumOf(r), 1, r.R.standard_error + r.T.standard_error) << part << " " << angle_deg;
                EXPECT_LT(r.R.standard_error, 1e-6) << part << " " << angle_deg;
                EXPECT_EQ(r.A.mean, 0);
            }
        }
}

// Walks know nothing of directions, orders and doubling; their errors are some 0.3 % of totals and 2 % of an angle.
TEST(OrdinateTotals, WalksAgree) {
    Judge judge;
    std::uint64_t seed = 70;
    struct Case {
        const char* name;
        SlabProblem problem;
    };
    const SlabLayer glass{1.5, 0, 0, 0, 1}, gap{1, 0, 0, 0, 0.2};
    for (const Case& c :
         {Case{"cuvette", {1, 1, {glass, {1.33, 0.05, 2, 0.5, 2}, glass}}},
          Case{"cuvette, oblique", {1, 1, {glass, {1.33, 0.05, 2, 0.5, 2}, glass}, 60}},
          Case{"gaps", {1, 1.3, {glass, gap, {1.4, 0.1, 3, 0.8, 1}, gap, {1.45, 0, 1, 0, 0.5}}, 30}},
          Case{"filter", {1, 1, {{1.5, 0.5, 0, 0, 0.5}, {1.4, 0.05, 1, 0.3, 1}}, 45}},
          Case{"into thicker glass", {1.5, 1, {{1.3, 0.1, 1, 0, 1}, {1.4, 0.1, 4, 0.9, 1}}, 50}},
          Case{"infinite, oblique", {1, 1, {{1.4, 0.1, 2, 0.7, 0.4}, {1.3, 0.2, 1, 0, infinity}}, 70}}}) {
        const SlabResult exact = solveSlabTotals(c.problem, 9);
        EXPECT_NEAR(sumOf(exact), 1, 1e-9) << c.name;
        SlabOptions options{.walks = 200'000, .seed = seed++, .edges_mm = {0, 1}, .angles = 9, .depth_mm = 1};
        Observer observer;
        const SlabResult walked = walkSlab(c.problem, options, observer);
        EXPECT_NEAR(walked.specular, exact.specular, 1e-14) << c.name;
        const auto compare = [&](const std::string& what, const Estimate& mine, const Estimate& truth) {
            if (truth.mean == 0 && mine.mean == 0) return;
            judge.compare(fmt::format("{}, {}", c.name, what),
                          {mine.mean, std::hypot(mine.standard_error, truth.standard_error), 0}, truth.mean,
                          2e5 * truth.mean);
        };
        compare("R", walked.R, exact.R);
        compare("R unscattered", walked.R_unscattered, exact.R_unscattered);
        compare("T", walked.T, exact.T);
        compare("T unscattered", walked.T_unscattered, exact.T_unscattered);
        for (std::size_t i = 0; i < exact.A_layer.size(); ++i)
            compare(fmt::format("A of layer {}", i + 1), walked.A_layer[i], exact.A_layer[i]);
        for (std::size_t i = 0; i < 9; ++i) {
            const auto at = [&](const SlabSeries& s) { return Estimate{s.mean[i], s.standard_error[i], 0}; };
            compare(fmt::format("R(angle {})", i), at(walked.R_a), at(exact.R_a));
            compare(fmt::format("T(angle {})", i), at(walked.T_a), at(exact.T_a));
        }
    }
    judge.expectAgreement();
}

TEST(OrdinateTotals, SayWhatTheyDoNotTake) {
    const SlabLayer layer{1.4, 0.1, 1, 0.5, 1};
    EXPECT_EQ(whyNotOrdinateTotals({1, 1, {layer}, 50, {BeamShape::flat, 1}}), "");
    EXPECT_EQ(whyNotOrdinateTotals({1, 1, {{3, 0.1, 0, 0, 1}}}), "") << "nothing scatters";
    EXPECT_THAT(whyNotOrdinateTotals({1, 1, {{3, 0.1, 1, 0, 1}}}), HasSubstr("factor of 2"));
    EXPECT_THAT(whyNotOrdinateTotals({1, 1, {{1.4, 0.1, 1, 0.97, 1}}}), HasSubstr("|g| 0.97"));
    EXPECT_THROW(solveSlabTotals({1, 1, {{1.4, 0.1, 1, 0.97, 1}}}), Error);
    EXPECT_THROW(solveSlabTotals({1, 1, {layer}, 90}), Error);
}

}  // namespace
}  // namespace searchlight
