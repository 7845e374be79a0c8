// Wide beams: a beam that is spread over the surface spreads what leaves it by its own moments.
#include "transport/walk/beam.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "judge.h"
#include "transport/half_space/half_space.h"
#include "transport/slab/slab.h"

namespace searchlight {
namespace {

HalfSpaceProblem problem(double angle_deg, BeamShape beam) {
    return {.sigma_a = 0.2, .sigma_s = 3, .g = 0.4, .eta = 1.4, .angle_deg = angle_deg, .beam = beam};
}

HalfSpaceResult walk(const HalfSpaceProblem& problem, std::uint64_t seed) {
    HalfSpaceOptions options;
    options.walks = 400'000;
    options.seed = seed;
    options.edges_mm = {0, 1, 2};
    Observer observer;
    return walkHalfSpace(problem, options, observer);
}

Estimate difference(const Estimate& a, const Estimate& b) {
    return {a.mean - b.mean, std::hypot(a.standard_error, b.standard_error), 0};
}

// The mean square radius of a flat disc is R^2 / 2, as that of a Gaussian which falls to 1/e^2 at R; under oblique
// light both are longer by 1 / cos along x.
TEST(Beam, AddsItsOwnSpreadToThatOfThePencil) {
    Judge judge;
    for (const double angle : {0.0, 60.0}) {
        const HalfSpaceResult pencil = walk(problem(angle, {}), 1);
        const double cosine = std::cos(angle * (std::numbers::pi / 180));
        for (const BeamShape::Kind kind : {BeamShape::flat, BeamShape::gaussian}) {
            const HalfSpaceResult wide = walk(problem(angle, {kind, 1.5}), 2 + static_cast<std::uint64_t>(kind));
            judge.compare("total", difference(wide.all.total, pencil.all.total), 0);
            judge.compare("shift", difference(wide.all.mean_x_mm, pencil.all.mean_x_mm), 0);
            judge.compare("spread", difference(wide.all.mean_r2_mm2, pencil.all.mean_r2_mm2),
                          1.5 * 1.5 / 4 * (1 + 1 / (cosine * cosine)));
        }
    }
    judge.expectAgreement();
}

TEST(Beam, OnASlabAgreesWithTheHalfSpace) {
    Judge judge;
    const HalfSpaceProblem half = problem(45, {BeamShape::flat, 0.8});
    HalfSpaceOptions options;
    options.walks = 400'000;
    options.edges_mm = {0, 0.5, 1, 2};
    options.grid = 6;
    options.grid_extent_mm = 1.5;
    Observer observer;
    const HalfSpaceResult a = walkHalfSpace(half, options, observer);

    SlabProblem slab;
    slab.angle_deg = half.angle_deg;
    slab.beam = half.beam;
    slab.layers = {{.n = half.eta,
                    .sigma_a = half.sigma_a,
                    .sigma_s = half.sigma_s,
                    .g = half.g,
                    .thickness_mm = std::numeric_limits<double>::infinity()}};
    SlabOptions tally;
    tally.walks = 400'000;
    tally.seed = 9;
    tally.edges_mm = options.edges_mm;
    tally.depth_mm = 1;
    tally.grid = options.grid;
    tally.grid_extent_mm = options.grid_extent_mm;
    const SlabResult b = walkSlab(slab, tally, observer);
    const auto compare = [&](const char* what, double mine, double error, double theirs, double their_error) {
        judge.compare(what, {mine, std::hypot(error, their_error), 0}, theirs);
    };
    for (std::size_t i = 0; i < a.all.Rd.size(); ++i)
        compare("R(r)", b.R_r.mean[i], b.R_r.standard_error[i], a.all.Rd[i], a.all.standard_error[i]);
    ASSERT_EQ(b.R_xy.mean.size(), 36u);
    for (std::size_t i = 0; i < 36; ++i)
        compare("R(x, y)", b.R_xy.mean[i], b.R_xy.standard_error[i], a.all.grid[i], a.all.grid_standard_error[i]);
    judge.expectAgreement();
}

// What a thin slab lets through stays under the beam: within it T(x, y) is even, outside it is none.
TEST(Beam, TheGridShowsWhereLightLeavesBelow) {
    SlabProblem slab;
    slab.beam = {BeamShape::flat, 1};
    slab.layers = {{.sigma_s = 1, .g = 0.99, .thickness_mm = 1e-3}};
    SlabOptions options;
    options.walks = 2'000'000;
    options.edges_mm = {0, 1};
    options.depth_mm = 1;
    options.grid = 4;
    options.grid_extent_mm = 4;
    Observer observer;
    const SlabResult result = walkSlab(slab, options, observer);
    double inner = 0;
    for (std::size_t i = 0; i < 16; ++i) {
        const bool beside_axis = i / 4 % 3 != 0 && i % 4 % 3 != 0;
        if (beside_axis)
            inner += result.T_xy.mean[i] * 4;
        else
            EXPECT_EQ(result.T_xy.mean[i], 0);
    }
    EXPECT_NEAR(inner, result.T.mean, 1e-12);
    EXPECT_GT(result.T.mean, 5e-4);
}

}  // namespace
}  // namespace searchlight
