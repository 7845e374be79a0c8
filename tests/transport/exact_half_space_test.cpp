#include "transport/exact/exact_half_space.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "base/error.h"
#include "exact.h"

namespace searchlight {
namespace {

using std::numbers::pi;

constexpr Estimate ExactOrders::*every_order[] = {&ExactOrders::all, &ExactOrders::single, &ExactOrders::multiple};

ExactHalfSpace ofAlbedoExact(double albedo) { return {1 - albedo, albedo}; }

// What two numbers differ by over what they claim.
double disagreement(const Estimate& a, const Estimate& b) {
    return std::abs(a.mean - b.mean) / (a.standard_error + b.standard_error);
}

TEST(ExactHalfSpace, TotalsMatchTheTableOfTheHFunction) {
    const CsvTable exact = table("halfspace_isotropic_matched.csv");
    for (std::size_t row = 0; row < exact.rows.size(); ++row) {
        const double albedo = exact.number(row, column(exact, "albedo"));
        for (const double cosine : {1.0, 0.9, 0.8, 0.7, 0.5, 0.3, 0.1}) {
            const double truth = exact.number(row, column(exact, fmt::format("R_mu0={:g}", cosine)));
            // Half of the last digit printed is 5e-15; the albedo itself is rounded.
            EXPECT_NEAR(exactTotal(1 - albedo, albedo, cosine).all.mean, truth, 3e-14) << albedo << ' ' << cosine;
        }
        const double H = (1 - exactTotal(1 - albedo, albedo, 1).all.mean) / std::sqrt(1 - albedo);
        EXPECT_NEAR(H, exact.number(row, column(exact, "H(1)")), 1e-12 / std::sqrt(1 - albedo)) << albedo;
    }
}

// The table's own inversion drifts beyond r = 7: its flux between the last radii contradicts its exitance there.
TEST(ExactHalfSpace, ProfileMatchesTheTable) {
    const CsvTable exact = table("searchlight_isotropic_matched.csv");
    for (const double albedo : {0.5, 0.9, 0.99}) {
        const ExactHalfSpace half_space = ofAlbedoExact(albedo);
        for (std::size_t row = 0; row < exact.rows.size(); ++row) {
            if (exact.number(row, column(exact, "albedo")) != albedo) continue;
            const double r = exact.number(row, column(exact, "r"));
            const ExactOrders Rd = half_space.Rd(r);
            // Nine digits are printed.
            EXPECT_NEAR(Rd.single.mean / exact.number(row, column(exact, "R_single")), 1, 5e-9) << albedo << ' ' << r;
            EXPECT_NEAR(half_space.within(r).all.mean, exact.number(row, column(exact, "F_encircled")), 1e-8);
            if (r > 7) continue;
            const double tolerance = r < 4 ? 5e-9 : 5e-7;
            EXPECT_NEAR(Rd.all.mean / exact.number(row, column(exact, "R_total")), 1, tolerance) << albedo << ' ' << r;
            EXPECT_NEAR(Rd.multiple.mean / exact.number(row, column(exact, "R_multiple")), 1, tolerance)
                << albedo << ' ' << r;
        }
    }
}

// Multiple scattering where the table ends: computed once more in extended precision, by Gauss-Legendre panels along a
// straight contour. The two agree to 1e-13.
TEST(ExactHalfSpace, TailMatchesAnotherContour) {
    const ExactHalfSpace half(0.5, 0.5), most(0.1, 0.9);
    struct {
        const ExactHalfSpace& half_space;
        double r, multiple;
    } const tail[] = {{half, 10, 2.75934283317637e-08}, {half, 15, 1.28549683181380e-10},
                      {half, 20, 6.99505648205593e-13}, {most, 10, 5.76459483411140e-06},
                      {most, 15, 1.95673806885575e-07}, {most, 20, 8.13563936200622e-09}};
    for (const auto& [half_space, r, multiple] : tail)
        EXPECT_NEAR(half_space.Rd(r).multiple.mean / multiple, 1, 1e-12) << multiple << ' ' << r;
}

// From 1e-7 mean free paths to 30: half the step and another contour.
TEST(ExactHalfSpace, StatedErrorsHoldUnderRefinement) {
    for (const double albedo : {0.001, 0.9, 1.0}) {
        const ExactHalfSpace coarse = ofAlbedoExact(albedo);
        const ExactHalfSpace fine(1 - albedo, albedo, {.step = 1.0 / 32, .tilt = pi / 6});
        double worst = 0;
        for (double r = 1e-7; r < 50; r *= 3) {
            const std::pair<ExactOrders, ExactOrders> pairs[] = {
                {coarse.Rd(r), fine.Rd(r)},
                {coarse.beyond(r), fine.beyond(r)},
                {coarse.annulusRd(r, 1.01 * r), fine.annulusRd(r, 1.01 * r)}};
            for (const auto& [a, b] : pairs)
                for (const auto order : every_order) worst = std::max(worst, disagreement(a.*order, b.*order));
        }
        EXPECT_LT(worst, 1) << albedo;
        for (const double diffusion_lengths : {1e-3, 1.0, 20.0}) {
            const double r = diffusion_lengths / std::sqrt(std::max(3 * (1 - albedo) * (1 - 0.4 * albedo), 1e-2));
            const Estimate Rd = coarse.Rd(r).all;
            EXPECT_LT(Rd.standard_error / Rd.mean, 1e-9) << albedo << ' ' << r;
        }
    }
}

// A central difference of fourth order in ln r leaves 1e-9.
TEST(ExactHalfSpace, ExitanceIsTheDerivativeOfTheFlux) {
    for (const double albedo : {0.3, 0.95}) {
        const ExactHalfSpace half_space = ofAlbedoExact(albedo);
        for (const double r : {0.001, 0.1, 1.0, 5.0, 20.0})
            for (const auto order : every_order) {
                const double h = 2e-3;
                const auto F = [&](double step) { return -(half_space.beyond(r * std::exp(step * h)).*order).mean; };
                const double slope = (8 * (F(1) - F(-1)) - (F(2) - F(-2))) / (12 * h * r);
                // Near the beam the flux is nearly constant: rounding of 1e-15 of it over the step.
                const double rounding = 1e-15 / h / r;
                EXPECT_NEAR(slope, 2 * pi * r * (half_space.Rd(r).*order).mean, 1e-9 * slope + rounding)
                    << albedo << ' ' << r;
            }
    }
}

TEST(ExactHalfSpace, FluxEndsAtTheTotal) {
    for (const double albedo : {1e-6, 0.2, 0.7, 0.98, 0.99999, 1.0}) {
        const ExactHalfSpace half_space = ofAlbedoExact(albedo);
        const ExactOrders total = exactTotal(1 - albedo, albedo, 1);
        for (const auto order : every_order) {
            EXPECT_LT(disagreement(half_space.total().*order, total.*order), 1) << albedo;
            for (const double r : {0.0, 0.02, 1.0, 30.0})
                EXPECT_NEAR((half_space.within(r).*order).mean + (half_space.beyond(r).*order).mean,
                            (total.*order).mean, 1e-12);
        }
        EXPECT_EQ(half_space.within(0).all.mean, 0);
    }
}

// [Chandrasekhar1960] chapter V: the first order of the law of diffuse reflection is a / 2 (1 - ln 2), the second a^2.
TEST(ExactHalfSpace, LittleScatteringIsSingle) {
    const ExactHalfSpace faint = ofAlbedoExact(1e-5), fainter = ofAlbedoExact(1e-6);
    EXPECT_NEAR(fainter.total().single.mean / (0.5e-6 * (1 - std::numbers::ln2)), 1, 1e-13);
    for (const double r : {1e-4, 0.1, 1.0, 10.0}) {
        const ExactOrders Rd = fainter.Rd(r);
        EXPECT_LT(Rd.multiple.mean, 1e-5 * Rd.all.mean) << r;
        // Third orders are 1e-5 of the second.
        EXPECT_NEAR(faint.Rd(r).multiple.mean / Rd.multiple.mean, 100, 2e-2) << r;
    }
}

TEST(ExactHalfSpace, LengthsScaleWithTheMeanFreePath) {
    const ExactHalfSpace unit(0.2, 0.8), dense(2, 8);
    for (const double r : {0.01, 1.0, 7.0}) {
        EXPECT_NEAR(dense.Rd(r / 10).all.mean / (100 * unit.Rd(r).all.mean), 1, 1e-12);
        EXPECT_NEAR(dense.within(r / 10).all.mean / unit.within(r).all.mean, 1, 1e-12);
    }
    EXPECT_NEAR(dense.meanR2().all.mean / (unit.meanR2().all.mean / 100), 1, 1e-12);
}

// <r^2> by parts is the integral of 2 r times the flux beyond r.
TEST(ExactHalfSpace, SecondMomentIsThatOfTheProfile) {
    const ExactHalfSpace half_space = ofAlbedoExact(0.8);
    double moment = 0;
    for (double u = -4; u < 5; u += 0.05) {
        const double r = std::exp(u - std::exp(-u));
        moment += 0.05 * 2 * r * half_space.beyond(r).all.mean * r * (1 + std::exp(-u));
    }
    EXPECT_NEAR(half_space.meanR2().all.mean * half_space.total().all.mean / moment, 1, 1e-10);
    EXPECT_EQ(ofAlbedoExact(1).meanR2().all.mean, std::numeric_limits<double>::infinity());
}

// Power: standard errors of 0.3 % to 10 % a bin; 34 bins of each order.
TEST(ExactHalfSpace, WalksAgreeAtAlbedosOfNoTable) {
    std::vector<double> edges = {0};
    for (double r = 0.01; r < 12; r *= 1.5) edges.push_back(r);
    for (const double albedo : {0.7, 0.95}) {
        Judge judge;
        const HalfSpaceProblem problem = ofAlbedo(albedo);
        const HalfSpaceResult walked = walk(problem, 1e6, 77, edges), exact = solveHalfSpace(problem, edges);
        for (const auto tally : {&HalfSpaceResult::single, &HalfSpaceResult::multiple}) {
            const HalfSpaceTally &w = walked.*tally, &e = exact.*tally;
            judge.compare("total", w.total, e.total.mean);
            judge.compare("<r^2>", w.mean_r2_mm2, e.mean_r2_mm2.mean);
            for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
                const double flux = e.Rd[i] * pi * (edges[i + 1] * edges[i + 1] - edges[i] * edges[i]);
                judge.compare(fmt::format("albedo {}, {} to {}", albedo, edges[i], edges[i + 1]),
                              {w.Rd[i], w.standard_error[i]}, e.Rd[i], flux * static_cast<double>(walked.walks));
            }
        }
        judge.expectAgreement();
    }
}

TEST(ExactHalfSpace, RefusesWhatItCannotSolve) {
    EXPECT_EQ(whyNotExact(ofAlbedo(0.5)), "");
    for (const HalfSpaceProblem& problem : {HalfSpaceProblem{.sigma_a = 1, .sigma_s = 1, .eta = 1.3},
                                            HalfSpaceProblem{.sigma_a = 1, .sigma_s = 1, .g = 0.1},
                                            HalfSpaceProblem{.sigma_a = 1, .sigma_s = 1, .angle_deg = 10}}) {
        EXPECT_NE(whyNotExact(problem), "");
        EXPECT_THROW(solveHalfSpace(problem, {0, 1}), Error);
    }
    EXPECT_THROW(solveHalfSpace(ofAlbedo(0.5), {0}), Error);
    EXPECT_THROW(solveHalfSpace(ofAlbedo(0.5), {0, 2, 1}), Error);
    EXPECT_THROW(solveHalfSpace(ofAlbedo(0.5), {-1, 1}), Error);
    EXPECT_THROW(ExactHalfSpace(0, 0), Error);
    EXPECT_THROW(ExactHalfSpace(-1, 2), Error);
    EXPECT_THROW(ExactHalfSpace(std::numeric_limits<double>::quiet_NaN(), 1), Error);
    EXPECT_THROW(ofAlbedoExact(0.5).Rd(0), Error);
    EXPECT_THROW(exactTotal(0.5, 0.5, 0), Error);
}

}  // namespace
}  // namespace searchlight
