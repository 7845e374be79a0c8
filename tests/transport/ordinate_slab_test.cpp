#include "transport/exact/ordinate_slab.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <map>

#include "base/error.h"
#include "exact.h"
#include "transport/exact/ordinate_stack.h"
#include "transport/exact/ordinate_totals.h"
#include "transport/exact/ordinates.h"

namespace searchlight {
namespace {

using Complex = std::complex<double>;
using testing::HasSubstr;

constexpr double infinity = std::numeric_limits<double>::infinity();

SlabProblem threeLayers() { return {1, 1, {{1.37, 0.1, 10, 0.9, 1}, {1.37, 0.1, 1, 0, 1}, {1.37, 0.2, 1, 0.7, 2}}}; }

// 28 cosines leave 1e-9 at g = 0.5, where the table ends. At g = 0.9 their 56 harmonics are nearly dependent, and
// rounding leaves up to 2e-7, by which 20 to 44 cosines differ.
TEST(OrdinateSlab, TotalsMatchAddingDoubling) {
    const std::map<std::string, SlabProblem> slabs{{"vdH_MCML_slab", {1, 1, {{1, 1, 9, 0.75, 0.2}}}},
                                                   {"vdH_iso_t1_a1", {1, 1, {{1, 0, 1, 0, 1}}}},
                                                   {"vdH_hg05_t1_a1", {1, 1, {{1, 0, 1, 0.5, 1}}}},
                                                   {"vdH_hg05_t1_a09", {1, 1, {{1, 0.1, 0.9, 0.5, 1}}}},
                                                   {"vdH_iso_mu05_t1_a099", {1, 1, {{1, 0.01, 0.99, 0, 1}}, 60}},
                                                   {"vdH_hg05_mu05_t4_a099", {1, 1, {{1, 0.01, 0.99, 0.5, 4}}, 60}},
                                                   {"MCML_3layer_n137", threeLayers()}};
    const CsvTable exact = table("slabs.csv");
    for (std::size_t row = 0; row < exact.rows.size(); ++row) {
        const std::string& name = exact.rows[row][0].text;
        const SlabResult found = solveSlabTotals(slabs.at(name));
        const bool sharp = slabs.at(name).layers.front().g > 0.5;
        const auto compare = [&](const Estimate& value, const char* what) {
            const double truth = exact.number(row, column(exact, what));
            EXPECT_NEAR(value.mean, truth, sharp ? 3e-7 : 2e-9) << name << " " << what;
            EXPECT_LE(std::abs(value.mean - truth), value.standard_error + 1e-9) << name << " " << what;
        };
        compare(found.R, "R_diffuse");
        compare(found.T, "T_diffuse");
        compare(found.A, "absorbed");
        EXPECT_NEAR(found.T_unscattered.mean, exact.number(row, column(exact, "T_collimated")), 1e-9) << name;
        EXPECT_NEAR(found.specular, exact.number(row, column(exact, "R_specular")), 1e-9) << name;
    }
}

TEST(OrdinateSlab, EverythingAddsUpToOne) {
    for (const SlabProblem& problem :
         {threeLayers(), SlabProblem{1, 1.2, {{1.4, 0.05, 1, 0.3, 1}, {1.33, 0, 2, 0.5, 1}, {1.5, 0.02, 0, 0, 2}}},
          SlabProblem{1.33, 1, {{1, 0.3, 1, -0.4, 1}, {1.4, 0.1, 1, 0.85, infinity}}}}) {
        const SlabResult r = solveSlabTotals(problem);
        EXPECT_NEAR(r.specular + r.R.mean + r.R_unscattered.mean + r.T.mean + r.T_unscattered.mean + r.A.mean, 1, 1e-9);
    }
}

OrdinateStack stackOf(double thickness, int parts, double eta, double g) {
    OrdinateStack stack{1, 1.2, {}};
    // Unit flux that enters; what comes back from below is left out in all cases.
    for (int i = 0; i < parts; ++i)
        stack.layers.push_back({.n = eta,
                                .sigma_t = 1,
                                .sigma_s = 0.9,
                                .thickness = thickness / parts,
                                .phase = smoothPhase(g, 14),
                                .beam_down = i == 0 ? 1 : std::exp(-thickness * i / parts)});
    return stack;
}

// Doubling against the star product of layers and interfaces without reflection: rounding is left.
TEST(OrdinateStack, ALayerInPiecesIsTheLayer) {
    const StackCount count{.escaping = 5, .trapped = 4, .azimuths = 6};
    for (const Complex rate : {Complex(0.2, 0), Complex(0.2, -3)}) {
        const StackFlux one = stackExitance(stackOf(1.3, 1, 1.4, 0.5), count, rate);
        const StackFlux three = stackExitance(stackOf(1.3, 3, 1.4, 0.5), count, rate);
        EXPECT_LT(std::abs(three.R - one.R), 1e-11) << rate;
        EXPECT_LT(std::abs(three.T - one.T), 1e-11) << rate;
    }
}

// The half-space has its own sums, by other directions: they agree to what both leave.
TEST(OrdinateStack, SecondOrderOfAThickSlabIsThatOfTheHalfSpace) {
    const StackCount count;
    for (const double g : {0.0, 0.5})
        for (const Complex rate : {Complex(0.2, -0.2), Complex(0.2, -3)}) {
            OrdinateStack stack = stackOf(infinity, 1, 1.3, g);
            stack.layers[0].phase = smoothPhase(g, 60);
            stack.layers[0].beam_down = 1;
            const Complex found = secondOrder(stack.layers[0], fineRays(stack, 0, count, rate), nullptr).R;
            const Complex truth =
                secondOrderTransform({0.9, g, 1.3}, {.second_panel = 14, .second_azimuths = 40}, rate);
            EXPECT_LT(std::abs(found - truth), 1e-4 * std::abs(truth)) << "g " << g << ", rate " << rate;
        }
}

// What is left of the phase function has the moments that are asked for, and the peak the rest.
TEST(SmoothPhase, KeepsTheLowMoments) {
    const SmoothPhase phase = smoothPhase(0.8, 10);
    EXPECT_DOUBLE_EQ(phase.peak, std::pow(0.8, 11));
    double zeroth = 0, first = 0;
    const GaussRule rule = gaussRule(20);
    for (std::size_t i = 0; i < rule.x.size(); ++i) {
        const double cosine = 2 * rule.x[i] - 1, weight = 4 * std::numbers::pi * rule.weight[i] * phase(cosine);
        zeroth += weight;
        first += weight * cosine;
    }
    EXPECT_NEAR(zeroth, 1, 1e-12);
    EXPECT_NEAR(phase.peak + (1 - phase.peak) * first, 0.8, 1e-12);
    EXPECT_EQ(smoothPhase(0.1, 20).peak, 0);
    EXPECT_EQ(smoothPhase(-0.5, 4).peak, 0);
}

TEST(OrdinateSlab, SaysWhatItDoesNotTake) {
    const SlabLayer layer{1.4, 0.1, 1, 0.5, 1};
    const auto with = [&](auto change) {
        SlabProblem problem{1, 1, {layer}};
        change(problem);
        return whyNotOrdinateSlab(problem);
    };
    EXPECT_EQ(with([](SlabProblem&) {}), "");
    EXPECT_THAT(with([](SlabProblem& p) { p.angle_deg = 30; }), HasSubstr("oblique"));
    EXPECT_THAT(with([](SlabProblem& p) { p.beam = {BeamShape::flat, 1}; }), HasSubstr("wide"));
    EXPECT_EQ(with([](SlabProblem& p) { p.layers.push_back({1.5, 0, 0, 0, 1}); }), "");
    EXPECT_THAT(with([](SlabProblem& p) { p.layers.push_back({1.5, 0, 0, 0, 9}); }), HasSubstr("along layer 2"));
    EXPECT_THAT(with([](SlabProblem& p) {
                    p.layers.push_back({1.3, 0, 0, 0, 1});
                }),
                HasSubstr("layer 2 is clear and of no higher"));
    EXPECT_THAT(with([](SlabProblem& p) { p.layers[0].g = 0.97; }), HasSubstr("|g| 0.97"));
    EXPECT_THAT(with([](SlabProblem& p) { p.n_below = 3; }), HasSubstr("factor of 2"));
    EXPECT_THAT(with([](SlabProblem& p) { p.layers[0].sigma_s = 0; }), HasSubstr("nothing scatters"));
    EXPECT_THAT(with([](SlabProblem& p) { p.layers[0].sigma_a = 0, p.layers[0].thickness_mm = infinity; }),
                HasSubstr("albedo 1 is above"));
    EXPECT_THROW(solveSlabTotals({1, 1, {{1.4, 0.1, 1, 0.99, 1}}}), Error);
    EXPECT_THROW(solveSlabTotals({1, 1, {{1.4, -0.1, 1, 0.5, 1}}}), Error);
    Observer observer;
    SlabOptions options;
    options.edges_mm = {0, 0.001, 1};
    try {
        solveSlab({1, 1, {layer}}, options, observer);
        FAIL();
    } catch (const Error& error) {
        EXPECT_THAT(error.what(), HasSubstr("the exact profile is asked for at 0.001 mm"));
    }
}

}  // namespace
}  // namespace searchlight
