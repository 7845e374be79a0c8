// The best estimator on slabs that nobody chose: thick and thin, clear and dark, up to four layers of any index.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/random.h"
#include "judge.h"
#include "transport/exact/ordinate_totals.h"
#include "transport/slab/slab.h"

namespace searchlight {
namespace {

SlabProblem randomSlab(std::uint64_t seed) {
    SplitMix64 random(seed);
    const auto between = [&](double low, double high) { return low + (high - low) * random.uniform(); };
    const auto index = [&](double matched, double high) { return random.uniform() < matched ? 1 : between(1, high); };
    SlabProblem problem{index(0.5, 1.5), index(0.5, 1.5), {}};
    const int layers = 1 + static_cast<int>(random.uniform() * 4);
    for (int i = 0; i < layers; ++i) {
        SlabLayer layer{.n = index(0.3, 1.6)};
        const double sigma_t = std::pow(10, between(-1, 1));
        const double absorbed = random.uniform() < 0.2 ? 0 : std::pow(10, between(-4, -0.05));
        layer.sigma_a = sigma_t * absorbed;
        layer.sigma_s = sigma_t - layer.sigma_a;
        layer.g = random.uniform() < 0.4 ? 0 : between(-0.6, 0.9);
        layer.thickness_mm = std::pow(10, between(-1.5, 1.3)) / sigma_t;
        if (i + 1 == layers && random.uniform() < 0.25 && absorbed > 1e-4)
            layer.thickness_mm = std::numeric_limits<double>::infinity();
        problem.layers.push_back(layer);
    }
    return problem;
}

double reach_mm(const SlabProblem& problem) {
    double depth = 0;
    for (const SlabLayer& layer : problem.layers)
        depth +=
            std::isinf(layer.thickness_mm) ? 10 / (layer.sigma_a + (1 - layer.g) * layer.sigma_s) : layer.thickness_mm;
    return depth;
}

// Transmittances down to 1e-8 among them, which a few heavy walks must not decide.
TEST(SlabBestRandom, AgreesWithAddingDoubling) {
    Judge judge;
    Observer observer;
    for (std::uint64_t seed = 0; seed < 100; ++seed) {
        const SlabProblem problem = randomSlab(seed);
        const SlabResult exact = solveSlabTotals(problem);
        SlabOptions options{.walks = 100'000, .seed = seed, .depths = 20};
        const double reach = reach_mm(problem);
        for (int i = 0; i <= 30; ++i) options.edges_mm.push_back(reach * i / 30);
        options.depth_mm = reach;
        options.estimator = SlabEstimator::best;
        const SlabResult walked = walkSlab(problem, options, observer);
        const auto compare = [&](const std::string& what, const Estimate& found, const Estimate& truth) {
            const double error = std::hypot(found.standard_error, truth.standard_error);
            // Of what is rarer than a walk in all nothing is known but that.
            if (truth.mean > 1e-9 && error < 0.3 * truth.mean)
                judge.compare(fmt::format("{} of slab {}", what, seed), {found.mean, error, found.count}, truth.mean);
            else
                EXPECT_LT(std::abs(found.mean - truth.mean), 5 * error + 1e-9) << what << " of slab " << seed;
        };
        compare("R", walked.R, exact.R);
        compare("T", walked.T, exact.T);
        compare("A", walked.A, exact.A);
        for (std::size_t i = 0; i < problem.layers.size(); ++i)
            compare(fmt::format("A of layer {}", i + 1), walked.A_layer[i], exact.A_layer[i]);
    }
    judge.expectAgreement();
}

}  // namespace
}  // namespace searchlight
