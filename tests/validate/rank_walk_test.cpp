#include "validate/rank_walk.h"

#include <cmath>

#include "base/error.h"
#include "formula_model.h"
#include "model/plane.h"
#include "transport/exact/exact_half_space.h"
#include "validate/model_shift.h"

namespace searchlight {
namespace {

Medium mediumOf(double sigma_a, double sigma_s, double g, double eta) {
    return makeMedium({sigma_a}, {sigma_s}, {g}, eta);
}

TEST(RankEdges, HaveOneAtTheMeanFreePath) {
    const std::vector<double> edges = rankEdges({.sigma_a = 0.1, .sigma_s = 2, .g = 0.6}, 20);
    EXPECT_EQ(edges.size(), 22u);
    EXPECT_TRUE(std::ranges::is_sorted(edges));
    EXPECT_TRUE(std::ranges::find(edges, 1 / 0.9) != edges.end());
}

TEST(RankWalk, IsExactWhereThatIsPossible) {
    Observer observer;
    const RankWalks walks = walkForRank(mediumOf(0.5, 1, 0, 1), 0, {.collisions = 1e6}, observer);
    EXPECT_TRUE(walks.exact);
    EXPECT_DOUBLE_EQ(walks.reference.total.mean, ExactHalfSpace(0.5, 1).total().all.mean);
    EXPECT_EQ(walks.reference.split_mm, 1 / 1.5);
    EXPECT_GT(walks.reference.mean_x_mm.mean, 10 * walks.reference.mean_x_mm.standard_error);
}

TEST(RankWalk, MeetsTheNoiseAskedForOrTheLimitOfWork) {
    Observer observer;
    RankEffort effort{.noise = 0.02, .shift_noise = 0.1, .collisions = 1e8};
    const auto noiseOf = [&] {
        const RankReference reference = walkForRank(mediumOf(0.05, 1, 0, 1.3), 0, effort, observer).reference;
        return rankScore(reference, {.bin_means = reference.Rd, .total = 1}).curve.noise;
    };
    // A trial of 4,096 walks in 64 chunks knows its errors to some 10 %; 25 % leaves room for what two bins in common
    // walks add.
    EXPECT_NEAR(noiseOf(), 0.02, 0.005);
    effort.noise = 1e-4;
    effort.collisions = 1e6;
    EXPECT_GT(noiseOf(), 1e-3) << "1e6 collisions cannot know it to 1e-4";
}

TEST(RankWalk, DoesNotDependOnThreads) {
    Observer observer;
    const Medium medium = mediumOf(0.05, 1, 0.5, 1.3);
    const RankEffort effort{.noise = 0.05, .shift_noise = 0.5, .collisions = 1e6, .threads = 1};
    RankEffort two = effort;
    two.threads = 2;
    const RankReference a = walkForRank(medium, 0, effort, observer).reference,
                        b = walkForRank(medium, 0, two, observer).reference;
    EXPECT_EQ(a.Rd, b.Rd);
    EXPECT_EQ(a.mean_x_mm.mean, b.mean_x_mm.mean);
}

TEST(RankWalk, FoldsThePlaneAndKeepsItsLight) {
    Observer observer;
    const RankWalks walks = walkForRank(mediumOf(0.05, 1, 0, 1.3), 0, {.collisions = 1e8}, observer);
    const RankReference& reference = walks.reference;
    ASSERT_EQ(reference.plane.size(), 24u * 12u);
    double light = 0, moment = 0;
    for (std::size_t i = 0; i < reference.plane.size(); ++i) {
        light += 2 * reference.plane[i] * reference.cell_mm * reference.cell_mm;
        moment += reference.plane[i] * (static_cast<double>(i % 24) - 11.5);
    }
    double whole = 0;
    for (const double Rd : walks.plane.all.grid) whole += Rd * reference.cell_mm * reference.cell_mm;
    EXPECT_NEAR(light, whole, 1e-12);
    EXPECT_GT(moment, 0) << "the refracted beam leans towards +x";
    EXPECT_LT(rankScore(reference, {.bin_means = reference.Rd, .total = 1, .plane = reference.plane}).oblique_noise,
              0.04);
}

TEST(RankWalk, LeavesOutAPlaneThatItCouldNotKnow) {
    Observer observer;
    const RankWalks walks = walkForRank(mediumOf(1, 0.01, 0.9, 1.3), 0, {.collisions = 1e6}, observer);
    EXPECT_TRUE(walks.reference.plane.empty());
    EXPECT_EQ(walks.plane.walks, 0u);
}

TEST(RankWalk, StopsWhenItIsTold) {
    struct Impatient : Observer {
        bool cancelled() const override { return true; }
    } observer;
    EXPECT_THROW(walkForRank(mediumOf(0.05, 1, 0, 1.3), 0, {}, observer), Error);
}

TEST(ModelShift, IsTheMeanOfADisplacedGaussian) {
    FormulaModel formula;
    formula.model.file.no_wi = formula.model.file.radial = false;
    // Leans to where the refracted beam goes by 0.7 mean free paths, at a width of one.
    formula.value = [](const Medium& medium, int c, const ParamValues&, const Query& query) {
        const double l = 1 / medium.sigmaTp()[c];
        const double x = query.xo.x + 0.7 * l * (query.wi.x < 0 ? 1 : 0);
        return std::exp(-(x * x + query.xo.y * query.xo.y) / (2 * l * l));
    };
    const Medium medium = mediumOf(0.1, 0.4, 0, 1.3);
    const auto evaluator = formula.factory()(formula.model, "cpu");
    evaluator->set(medium, {});
    // By a smooth integrand in the logarithm of r, cut where 1e-8 of it is left.
    EXPECT_NEAR(modelMeanX(*evaluator, formula.model, medium, 45).r, -0.7 * 2, 1e-6);
    EXPECT_EQ(modelMeanX(*evaluator, formula.model, medium, 0).r, 0);
    formula.model.file.no_wi = true;
    EXPECT_EQ(modelMeanX(*evaluator, formula.model, medium, 45).r, 0);
}

TEST(ModelPlane, HasTheMeansOfItsCells) {
    FormulaModel formula;
    // Linear in x, so that the mean of a cell is the value at its middle, whatever the points; from -x outwards.
    formula.value = [](const Medium&, int, const ParamValues&, const Query& query) {
        return 10 + query.xo.x + 100 * query.xo.y;
    };
    const Medium medium = mediumOf(0.1, 0.4, 0, 1.3);
    const auto evaluator = formula.factory()(formula.model, "cpu");
    evaluator->set(medium, {});
    const std::vector<double> means = modelPlane(*evaluator, formula.model, medium, 45, 0, 4, 0.5);
    ASSERT_EQ(means.size(), 8u);
    EXPECT_NEAR(means[0], 10 - 0.75 + 25, 1e-12);
    EXPECT_NEAR(means[3], 10 + 0.75 + 25, 1e-12);
    EXPECT_NEAR(means[4], 10 - 0.75 + 75, 1e-12);
}

}  // namespace
}  // namespace searchlight
