// Whole profiles of slabs by ordinates: tens of seconds of CPU each.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <limits>

#include "exact.h"
#include "transport/exact/exact_half_space.h"
#include "transport/exact/ordinate_half_space.h"
#include "transport/exact/ordinate_slab.h"

namespace searchlight {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// From the smallest radius on, in reduced mean free paths.
const std::vector<double> edges_mfp = {0, 0.1, 0.2, 0.3, 0.5, 0.7, 1, 1.5, 2, 3, 5, 7, 10};

SlabResult solve(const SlabProblem& problem, const std::vector<double>& edges) {
    SlabOptions options;
    options.edges_mm = edges;
    Observer observer;
    return solveSlab(problem, options, observer);
}

// The H function knows the half-space to 1e-10; 40 mean free paths of albedo 0.9 are none but for 1e-9.
TEST(OrdinateSlab, ThickSlabMatchesTheHFunction) {
    const ExactHalfSpace exact(0.1, 0.9);
    for (const double thickness : {40.0, infinity}) {
        const SlabResult found = solve({1, 1, {{1, 0.1, 0.9, 0, thickness}}}, edges_mfp);
        EXPECT_NEAR(found.R.mean, exact.total().all.mean, 1e-8);
        double worst = 0;
        for (std::size_t i = 0; i + 1 < edges_mfp.size(); ++i) {
            const double truth = exact.annulusRd(edges_mfp[i], edges_mfp[i + 1]).all.mean;
            worst = std::max(worst, std::abs(found.R_r.mean[i] / truth - 1));
            EXPECT_LT(std::abs(found.R_r.mean[i] - truth), found.R_r.standard_error[i]) << edges_mfp[i];
        }
        EXPECT_LT(worst, 1e-4);
        RecordProperty(fmt::format("worst_{}", thickness), fmt::format("{:.2e}", worst));
    }
}

// Walks know nothing of directions. Power: their standard errors are 0.05 % to 0.5 % of a bin.
TEST(OrdinateSlab, WalksAgree) {
    Judge judge;
    std::uint64_t seed = 1;
    struct Case {
        const char* name;
        SlabProblem problem;
        double walks;
    };
    for (const Case& c : {Case{"matched sheet", {1, 1, {{1, 0.1, 0.9, 0.5, 1}}}, 2e7},
                          Case{"glued", {1, 1.2, {{1.4, 0.05, 1, 0.3, 2}}}, 1e7},
                          Case{"two layers", {1, 1, {{1.4, 0.05, 2, 0.5, 0.5}, {1.33, 0.1, 1, 0, 2}}}, 1e7},
                          Case{"under glass", {1, 1, {{1.5, 0, 0, 0, 0.15}, {1.35, 0.1, 3, 0.8, 3}}}, 1e7},
                          Case{"skin-like", {1, 1, {{1.4, 0.05, 5, 0.8, 2}}}, 2e7},
                          Case{"forward, infinite", {1, 1, {{1.4, 0.05, 10, 0.9, infinity}}}, 1e7},
                          Case{"lossless on infinite", {1, 1, {{1.4, 0, 1, 0, 1}, {1.4, 0.1, 1, 0, infinity}}}, 2e6}}) {
        const SlabLayer& first = c.problem.layers[c.problem.layers.front().clear() ? 1 : 0];
        std::vector<double> edges = edges_mfp;
        for (double& edge : edges) edge /= first.sigma_a + (1 - first.g) * first.sigma_s;
        const SlabResult exact = solve(c.problem, edges);
        SlabOptions options;
        options.walks = static_cast<std::uint64_t>(c.walks);
        options.seed = seed++;
        options.edges_mm = edges;
        options.depth_mm = 1;
        options.estimator = SlabEstimator::best;
        Observer observer;
        const SlabResult walked = walkSlab(c.problem, options, observer);
        const auto compare = [&](const std::string& what, const Estimate& mine, const Estimate& truth) {
            judge.compare(fmt::format("{}, {}", c.name, what),
                          {mine.mean, std::hypot(mine.standard_error, truth.standard_error), 0}, truth.mean);
        };
        compare("R", walked.R, exact.R);
        if (exact.T.mean > 0) compare("T", walked.T, exact.T);
        compare("A", walked.A, exact.A);
        const auto compareSeries = [&](const char* what, const SlabSeries& mine, const SlabSeries& truth) {
            for (std::size_t i = 0; i < mine.mean.size(); ++i)
                compare(fmt::format("{} from {}", what, edges[i]), {mine.mean[i], mine.standard_error[i], 0},
                        {truth.mean[i], truth.standard_error[i], 0});
        };
        compareSeries("R(r)", walked.R_r, exact.R_r);
        if (exact.T.mean > 0) compareSeries("T(r)", walked.T_r, exact.T_r);
    }
    judge.expectAgreement();
}

// Forward scattering is solved as a slab; by orders.
TEST(OrdinateHalfSpace, ForwardScatteringAgreesWithWalks) {
    const HalfSpaceProblem problem{.sigma_a = 0.1, .sigma_s = 5, .g = 0.8, .eta = 1.4};
    std::vector<double> edges = edges_mfp;
    for (double& edge : edges) edge /= problem.sigma_a + (1 - problem.g) * problem.sigma_s;
    Observer observer;
    const HalfSpaceResult exact = solveAnyHalfSpace(problem, edges, 0, observer);
    const HalfSpaceResult walked = walk(problem, 1e7, 5, edges, Estimator::best);
    EXPECT_NEAR(walked.specular, exact.specular, 1e-14);
    Judge judge;
    for (HalfSpaceTally HalfSpaceResult::*order : {&HalfSpaceResult::all, &HalfSpaceResult::multiple}) {
        const HalfSpaceTally &a = exact.*order, &b = walked.*order;
        const auto compare = [&](const std::string& what, const Estimate& truth, const Estimate& mine) {
            judge.compare(what, {mine.mean, std::hypot(mine.standard_error, truth.standard_error), 0}, truth.mean);
        };
        compare("total", a.total, b.total);
        compare("<r^2>", a.mean_r2_mm2, b.mean_r2_mm2);
        for (std::size_t i = 0; i < a.Rd.size(); ++i)
            compare(fmt::format("Rd from {}", edges[i]), {a.Rd[i], a.standard_error[i]},
                    {b.Rd[i], b.standard_error[i]});
    }
    judge.expectAgreement();
    for (std::size_t i = 0; i < exact.single.Rd.size(); ++i)
        EXPECT_NEAR(exact.all.Rd[i], exact.single.Rd[i] + exact.multiple.Rd[i], 1e-15);
}

}  // namespace
}  // namespace searchlight
