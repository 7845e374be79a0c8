// The low-variance walk through layers against adding-doubling, the half-space and the analogue walk.
#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <atomic>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "base/csv.h"
#include "base/files.h"
#include "instruction_sets.h"
#include "judge.h"
#include "transport/half_space/half_space.h"
#include "transport/slab/slab.h"

namespace searchlight {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

SlabResult walk(const SlabProblem& problem, double walks, std::uint64_t seed,
                SlabEstimator estimator = SlabEstimator::best, int threads = 0, double width = 0.1) {
    SlabOptions o;
    o.walks = static_cast<std::uint64_t>(walks);
    o.seed = seed;
    for (int i = 0; i <= 30; ++i) o.edges_mm.push_back(width * i);
    o.angles = 6;
    o.depths = 8;
    o.depth_mm = 4;
    o.threads = threads;
    o.estimator = estimator;
    Observer observer;
    return walkSlab(problem, o, observer);
}

Estimate both(const Estimate& a, const Estimate& b) {
    return {a.mean, std::hypot(a.standard_error, b.standard_error), a.count};
}

struct Case {
    const char* name;
    SlabProblem problem;
    double walks;
    double width;  // of the annuli, mm
};

const Case cases[] = {
    {"sheet", {1, 1, {{1, 1, 9, 0.7, 0.2}}}, 3e5, 0.02},
    {"matched", {1, 1, {{1, 0, 1, 0, 1}}}, 3e5, 0.1},
    {"oblique", {1, 1, {{1, 0.01, 0.99, 0.5, 4}}, 60}, 1e5, 0.2},
    {"thin, reflecting", {1, 1.2, {{1.6, 0.05, 1, 0, 0.3}}}, 3e5, 0.05},
    {"unlike above and below", {1, 1.2, {{1.4, 0.05, 1, 0.3, 3}}, 30}, 1e5, 0.13},
    {"half-space", {1, 1, {{1.5, 0.1, 2, 0, infinity}}}, 2e5, 0.05},
    {"two layers", {1, 1, {{1.5, 0.05, 2, 0, 1}, {1.3, 0.1, 3, 0.4, 2}}}, 1e5, 0.05},
    {"forward below", {1, 1, {{1.3, 0.05, 2, 0, 1}, {1.5, 0.1, 6, 0.9, infinity}}, 40}, 1e5, 0.1},
    {"falling index", {1.5, 1, {{1.2, 0.3, 1, -0.3, 1}, {1.1, 0.05, 1, 0, 1}, {1.3, 0, 2, 0, 0.5}}, 20}, 1e5, 0.1},
};

// tests/data/transport/slabs.csv. Power: standard errors are 0.1 % to 0.5 % of R and T.
TEST(SlabBest, AgreesWithAddingDoubling) {
    const std::map<std::string, SlabProblem> slabs{{"vdH_MCML_slab", {1, 1, {{1, 1, 9, 0.75, 0.2}}}},
                                                   {"vdH_iso_t1_a1", {1, 1, {{1, 0, 1, 0, 1}}}},
                                                   {"vdH_hg05_t1_a1", {1, 1, {{1, 0, 1, 0.5, 1}}}},
                                                   {"vdH_hg05_t1_a09", {1, 1, {{1, 0.1, 0.9, 0.5, 1}}}},
                                                   {"vdH_iso_mu05_t1_a099", {1, 1, {{1, 0.01, 0.99, 0, 1}}, 60}},
                                                   {"vdH_hg05_mu05_t4_a099", {1, 1, {{1, 0.01, 0.99, 0.5, 4}}, 60}}};
    const std::filesystem::path path = std::filesystem::path(SEARCHLIGHT_SOURCE_DIR) / "tests/data/transport/slabs.csv";
    const CsvTable table = parseCsv(readFile(path), "slabs.csv");
    const auto number = [&](std::size_t row, const char* column) {
        return table.number(row, table.find(column).value());
    };
    Judge judge;
    int walked = 0;
    for (std::size_t row = 0; row < table.rows.size(); ++row) {
        const auto slab = slabs.find(table.rows[row][0].text);
        if (slab == slabs.end()) continue;
        ++walked;
        const SlabResult r = walk(slab->second, 5e5, 1100 + row);
        EXPECT_EQ(r.estimator, SlabEstimator::best) << slab->first;
        judge.compare(slab->first + " R", r.R, number(row, "R_diffuse"));
        judge.compare(slab->first + " T", r.T, number(row, "T_diffuse"));
        // Exact; the table has ten digits.
        EXPECT_NEAR(r.T_unscattered.mean, number(row, "T_collimated"), 1e-10) << slab->first;
        if (number(row, "absorbed") > 1e-9) judge.compare(slab->first + " A", r.A, number(row, "absorbed"));
    }
    EXPECT_EQ(walked, 6);
    judge.expectAgreement();
}

TEST(SlabBest, AgreesWithTheAnalogueWalk) {
    Judge judge;
    std::uint64_t seed = 2000;
    for (const Case& one : cases) {
        const SlabResult a = walk(one.problem, 5 * one.walks, seed++, SlabEstimator::analogue, 0, one.width),
                         b = walk(one.problem, one.walks, seed++, SlabEstimator::best, 0, one.width);
        ASSERT_EQ(b.estimator, SlabEstimator::best) << one.name;
        const auto compare = [&](const std::string& what, const Estimate& x, const Estimate& y) {
            if (!(x.mean > 0 || y.mean > 0)) return;  // nothing, or no medium there
            judge.compare(std::string(one.name) + ", " + what, both(y, x), x.mean,
                          std::pow(x.mean / x.standard_error, 2));
        };
        compare("R", a.R, b.R);
        compare("R of order 1", a.R_single, b.R_single);
        compare("R unscattered", a.R_unscattered, b.R_unscattered);
        compare("T", a.T, b.T);
        compare("T unscattered", a.T_unscattered, b.T_unscattered);
        compare("A", a.A, b.A);
        for (const auto& [what, mine, theirs] :
             {std::tuple("R(r)", &b.R_r, &a.R_r), std::tuple("R(r) of order 1", &b.R_r_single, &a.R_r_single),
              std::tuple("T(r)", &b.T_r, &a.T_r), std::tuple("R(angle)", &b.R_a, &a.R_a),
              std::tuple("T(angle)", &b.T_a, &a.T_a),
              // Over sigma_a the same numbers: counted twice they would look like a shift common to all.
              a.A.mean > 0 ? std::tuple("A(z)", &b.A_z, &a.A_z) : std::tuple("fluence", &b.fluence_z, &a.fluence_z)})
            for (std::size_t i = 0; i < mine->mean.size(); ++i)
                compare(std::string(what) + " " + std::to_string(i), {theirs->mean[i], theirs->standard_error[i], 0},
                        {mine->mean[i], mine->standard_error[i], 0});
        if (a.A.mean > 0) {
            const double left = b.R.mean + b.R_unscattered.mean + b.T.mean + b.T_unscattered.mean;
            EXPECT_NEAR(b.specular + left + b.A.mean, 1, 1e-12);
        }
        for (std::size_t i = 0; i < b.R_r.mean.size(); ++i)
            EXPECT_NEAR(b.R_r_single.mean[i] + b.R_r_multiple.mean[i], b.R_r.mean[i], 1e-12 * b.R_r.mean[i]);
    }
    judge.expectAgreement();
}

// A medium without an end, whole and cut into layers, by walks that share nothing but the way they are led.
TEST(SlabBest, AnInfiniteLayerAgreesWithTheHalfSpace) {
    Judge judge;
    Observer observer;
    for (const HalfSpaceProblem& p :
         {HalfSpaceProblem{.sigma_a = 0.1, .sigma_s = 2, .eta = 1.5},
          HalfSpaceProblem{.sigma_a = 0.1, .sigma_s = 3, .g = 0.4, .eta = 1.3, .angle_deg = 50}}) {
        HalfSpaceOptions half{.walks = 500'000, .seed = 3000, .estimator = Estimator::best};
        for (int i = 0; i <= 30; ++i) half.edges_mm.push_back(0.1 * i);
        const HalfSpaceResult a = walkHalfSpace(p, half, observer);
        const SlabLayer whole{p.eta, p.sigma_a, p.sigma_s, p.g, infinity};
        SlabLayer top = whole;
        top.thickness_mm = 0.4;
        for (const std::vector<SlabLayer>& layers : {std::vector{whole}, std::vector{top, whole}}) {
            const SlabResult b = walk({1, 1, layers, p.angle_deg}, 2e5, 3001 + layers.size());
            ASSERT_EQ(b.estimator, SlabEstimator::best);
            judge.compare("R", both(b.R, a.all.total), a.all.total.mean);
            for (std::size_t i = 0; i < a.all.Rd.size(); ++i)
                judge.compare(
                    "R(r) " + std::to_string(i),
                    both({b.R_r.mean[i], b.R_r.standard_error[i], 0}, {a.all.Rd[i], a.all.standard_error[i], 0}),
                    a.all.Rd[i]);
        }
    }
    judge.expectAgreement();
}

std::vector<double> numbers(const SlabResult& r) {
    std::vector<double> all = r.flux;
    for (const Estimate& e : {r.R, r.R_single, r.T, r.T_unscattered, r.A}) all.push_back(e.standard_error);
    for (const SlabSeries* series : {&r.R_r, &r.R_r_single, &r.T_r, &r.R_a, &r.A_z})
        all.insert(all.end(), series->standard_error.begin(), series->standard_error.end());
    all.push_back(static_cast<double>(r.collisions));
    return all;
}

SlabResult onTarget(std::int64_t target, const Case& one, double walks) {
    hwy::SetSupportedTargetsForTest(target);
    const SlabResult result = walk(one.problem, walks, 1, SlabEstimator::best, 0, one.width);
    hwy::SetSupportedTargetsForTest(0);
    return result;
}

TEST(SlabBest, Avx2AndAvx512AgreeBitForBit) {
    if (!hasInstructionSet(HWY_AVX3)) GTEST_SKIP() << "no AVX-512 here";
    for (const Case& one : cases)
        EXPECT_EQ(numbers(onTarget(HWY_AVX3, one, 2e4)), numbers(onTarget(HWY_AVX2, one, 2e4))) << one.name;
}

TEST(SlabBest, ResultDoesNotDependOnThreads) {
    for (const Case& one : cases)
        EXPECT_EQ(numbers(walk(one.problem, 2e4, 1, SlabEstimator::best, 1, one.width)),
                  numbers(walk(one.problem, 2e4, 1, SlabEstimator::best, 2, one.width)))
            << one.name;
}

TEST(SlabBest, TargetsWithoutFusedMultiplyAddAgreeStatistically) {
    Judge judge;
    std::uint64_t seed = 4000;
    for (const std::int64_t target : {HWY_SSE4, HWY_EMU128}) {
        if (target == HWY_SSE4 && !hasInstructionSet(HWY_SSE4)) continue;
        for (const Case& one : cases) {
            const SlabResult a = walk(one.problem, 5e4, seed++, SlabEstimator::best, 0, one.width),
                             b = onTarget(target, one, target == HWY_SSE4 ? 5e4 : 3e3);
            judge.compare(one.name, both(b.R, a.R), a.R.mean);
            for (const std::size_t i : {1, 5, 20})
                judge.compare(
                    one.name,
                    both({b.R_r.mean[i], b.R_r.standard_error[i], 0}, {a.R_r.mean[i], a.R_r.standard_error[i], 0}),
                    a.R_r.mean[i], 3e3 * a.R_r.mean[i]);
        }
    }
    judge.expectAgreement();
}

// Cancels after so many reports of progress.
class Impatient : public Observer {
public:
    void progress(std::string_view, std::uint64_t, std::uint64_t, std::string_view) override { --patience_; }
    bool cancelled() const override { return patience_ <= 0; }

private:
    std::atomic<int> patience_ = 9;
};

TEST(SlabBest, AnInterruptedWalkGoesOnToTheNumbersOfOneThatNeverStopped) {
    Observer calm;
    SlabOptions o{.walks = 20'000, .edges_mm = {0, 0.1, 1, 3}, .depth_mm = 1, .threads = 2};
    o.estimator = SlabEstimator::best;
    const SlabResult whole = walkSlab(cases[6].problem, o, calm);
    WalkState state;
    o.control.state = &state;
    Impatient impatient;
    EXPECT_TRUE(walkSlab(cases[6].problem, o, impatient).interrupted);
    EXPECT_EQ(numbers(walkSlab(cases[6].problem, o, calm)), numbers(whole));
}

// The estimator that it is for: profiles in narrow annuli, and totals, per collision.
TEST(SlabBest, KnowsProfilesBetterThanTheAnalogueWalk) {
    const SlabProblem marble{1, 1, {{1.5, 0.0021, 2.19, 0, 10}}};
    const SlabResult a = walk(marble, 1e5, 5000, SlabEstimator::analogue, 0, 0.05),
                     b = walk(marble, 5e4, 5000, SlabEstimator::best, 0, 0.05);
    double gain = 0;
    for (const std::size_t i : {5, 10, 20}) gain += std::pow(a.R_r.standard_error[i] / b.R_r.standard_error[i], 2) / 3;
    const double cost = static_cast<double>(b.collisions) / static_cast<double>(a.collisions);
    EXPECT_GT(gain, 2 * cost);
    for (const auto total : {&SlabResult::R, &SlabResult::T, &SlabResult::A})
        EXPECT_GT(std::pow((a.*total).standard_error / (b.*total).standard_error, 2), 2 * cost);
}

std::vector<std::vector<SlabLayer>> slabsOfAnalogueWalks() {
    const SlabLayer forward{1.4, 0.1, 10, 0.95, 1}, glass{1.5, 0, 0, 0, 1};
    SlabLayer tabulated{1, 0.1, 1, 0, 1};
    tabulated.phase = rayleighPhase();
    return {{forward}, {glass, {1.3, 0.1, 1, 0, 1}, glass}, {tabulated}, {glass, {1.4, 0, 1, 0, 2}}};
}

TEST(SlabBest, LeavesToTheAnalogueWhatThatDoesBetter) {
    for (const std::vector<SlabLayer>& layers : slabsOfAnalogueWalks()) {
        const SlabProblem problem{1, 1, layers};
        const SlabResult a = walk(problem, 1000, 6, SlabEstimator::analogue), b = walk(problem, 1000, 6);
        EXPECT_EQ(b.estimator, SlabEstimator::best);
        EXPECT_FALSE(b.foresees);
        // Known exactly, also there, up to the rounding of squares: not with the error of one event, 1e-3.
        EXPECT_LT(b.R_unscattered.standard_error, 1e-7);
        EXPECT_LT(b.T_unscattered.standard_error, 1e-7);
        if (layers.size() > 1) continue;  // controls are told by a part of them, and the others are other walks
        for (std::size_t i = 0; i < a.R_r.mean.size(); ++i) {
            EXPECT_NEAR(b.R_r.mean[i], a.R_r.mean[i], 1e-12);
            EXPECT_NEAR(b.T_r.mean[i], a.T_r.mean[i], 1e-12);
        }
    }
}

// Most walks meet nothing: that few or many do says nothing about absorption, whose error stays that of counts. Power:
// the noise of unscattered light would make it 10 times larger; standard errors are known to 9 %.
TEST(SlabBest, KnowsWhatLittleIsAbsorbedInAThinSlab) {
    for (const double g : {0.0, 0.9}) {
        const SlabProblem problem{1, 1, {{1, 1e-4, 0.0099, g, 1}}};
        const SlabResult best = walk(problem, 4e6, 5), analogue = walk(problem, 4e6, 6, SlabEstimator::analogue);
        const double counts = std::sqrt(analogue.A.mean / static_cast<double>(best.walks));
        EXPECT_LT(best.A.standard_error, 1.2 * counts) << g;
        EXPECT_LT(best.R.standard_error, 1.2 * analogue.R.standard_error) << g;
        EXPECT_LT(best.T.standard_error, 1.2 * analogue.T.standard_error) << g;
        EXPECT_NEAR(best.A.mean, analogue.A.mean, 4 * both(best.A, analogue.A).standard_error) << g;
        EXPECT_LT(best.T_unscattered.standard_error, 1e-7) << g;
        // Everything ends somewhere, up to rounding.
        EXPECT_NEAR(best.R.mean + best.R_unscattered.mean + best.T.mean + best.T_unscattered.mean + best.A.mean, 1,
                    1e-9);
    }
}

// A handful of absorbed walks says less about the fluence than where all walks collided. Power: levelled to these, its
// error would be twice as large, that of a few absorptions in a chunk.
TEST(SlabBest, WeakAbsorptionLeavesTheFluenceAsItIs) {
    const SlabResult none = walk({1, 1, {{1, 0, 1, 0, 4}}}, 1e5, 7), weak = walk({1, 1, {{1, 3e-4, 1, 0, 4}}}, 1e5, 7);
    ASSERT_TRUE(none.foresees && weak.foresees);
    for (std::size_t i = 0; i < none.fluence_z.mean.size(); ++i)
        EXPECT_LT(weak.fluence_z.standard_error[i], 1.3 * none.fluence_z.standard_error[i]) << i;
}

// Their totals and series follow controls; the walks are others.
TEST(SlabBest, AnalogueWalksWithControlsAgreeWithThoseWithout) {
    Judge judge;
    std::uint64_t seed = 7000;
    for (const std::vector<SlabLayer>& layers : slabsOfAnalogueWalks())
        for (const double angle : {0.0, 50.0}) {
            const SlabProblem problem{1, 1, layers, angle};
            const SlabResult a = walk(problem, 2e5, seed++, SlabEstimator::analogue), b = walk(problem, 1e5, seed++);
            const auto compare = [&](const char* what, const Estimate& x, const Estimate& y) {
                if (x.mean > 0 || y.mean > 0)
                    judge.compare(std::string(what) + std::to_string(seed), both(x, y), y.mean,
                                  std::pow(x.mean / x.standard_error, 2));
            };
            EXPECT_NEAR(b.specular + b.R.mean + b.R_unscattered.mean + b.T.mean + b.T_unscattered.mean + b.A.mean, 1,
                        1e-12);
            compare("R", a.R, b.R);
            compare("R of order 1", a.R_single, b.R_single);
            compare("R unscattered", a.R_unscattered, b.R_unscattered);
            compare("T", a.T, b.T);
            compare("T unscattered", a.T_unscattered, b.T_unscattered);
            compare("A", a.A, b.A);
            for (const auto& [what, mine, theirs] :
                 {std::tuple("A(z)", &b.A_z, &a.A_z), std::tuple("R(angle)", &b.R_a, &a.R_a),
                  std::tuple("T(angle)", &b.T_a, &a.T_a)})
                for (std::size_t i = 0; i < mine->mean.size(); ++i)
                    compare(what, {theirs->mean[i], theirs->standard_error[i], 0},
                            {mine->mean[i], mine->standard_error[i], 0});
        }
    judge.expectAgreement();
}

}  // namespace
}  // namespace searchlight
