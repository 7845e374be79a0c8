#include "transport/half_space/half_space.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hwy/highway.h>

#include <atomic>
#include <cmath>
#include <numbers>

#include "base/error.h"
#include "exact.h"
#include "instruction_sets.h"

namespace searchlight {
namespace {

using testing::HasSubstr;

constexpr HalfSpaceProblem problems[] = {
    {.sigma_a = 0.1, .sigma_s = 0.9, .g = 0, .eta = 1, .angle_deg = 40},
    {.sigma_a = 0.1, .sigma_s = 0.9, .g = 0, .eta = 1.5, .angle_deg = 0},
    {.sigma_a = 0.02, .sigma_s = 5, .g = 0.8, .eta = 1, .angle_deg = 0},
    {.sigma_a = 0.02, .sigma_s = 5, .g = -0.3, .eta = 1.3, .angle_deg = 70},
};

HalfSpaceOptions options(std::uint64_t walks) {
    HalfSpaceOptions o;
    o.walks = walks;
    o.edges_mm = {0, 0.01, 0.1, 0.3, 1, 3};
    o.grid = 8;
    o.grid_extent_mm = 2;
    o.strip_edges_mm = {-2, -1, -0.5, 0, 0.5, 2};
    o.strip_half_width_mm = 0.5;
    return o;
}

// Every number, as one list: equal lists mean equal results, bit for bit.
std::vector<double> numbers(const HalfSpaceResult& result) {
    std::vector<double> all = {result.specular, static_cast<double>(result.walks),
                               static_cast<double>(result.collisions)};
    for (const HalfSpaceTally* tally : {&result.all, &result.single, &result.multiple}) {
        for (const Estimate& e : {tally->total, tally->mean_x_mm, tally->mean_r2_mm2})
            all.insert(all.end(), {e.mean, e.standard_error});
        for (const auto* list : {&tally->Rd, &tally->standard_error, &tally->beyond, &tally->grid,
                                 &tally->grid_standard_error, &tally->strip, &tally->strip_standard_error})
            all.insert(all.end(), list->begin(), list->end());
    }
    return all;
}

HalfSpaceResult onTarget(std::int64_t target, const HalfSpaceProblem& problem, std::uint64_t walks) {
    Observer observer;
    hwy::SetSupportedTargetsForTest(target);
    const HalfSpaceResult result = walkHalfSpace(problem, options(walks), observer);
    hwy::SetSupportedTargetsForTest(0);
    return result;
}

TEST(HalfSpace, ResultDoesNotDependOnThreads) {
    Observer observer;
    for (const HalfSpaceProblem& problem : problems) {
        HalfSpaceOptions o = options(200'000);
        o.threads = 1;
        const HalfSpaceResult one = walkHalfSpace(problem, o, observer);
        o.threads = 2;
        const HalfSpaceResult two = walkHalfSpace(problem, o, observer);
        EXPECT_EQ(two.threads, 2);
        EXPECT_EQ(numbers(one), numbers(two));
        o.seed = 2;
        EXPECT_NE(numbers(one), numbers(walkHalfSpace(problem, o, observer)));
    }
}

TEST(HalfSpace, StripIsTheMiddleOfTheGrid) {
    Observer observer;
    // Cells of the grid are half a mm wide; the strip holds its rows 3 and 4.
    const HalfSpaceResult result = walkHalfSpace(problems[3], options(100'000), observer);
    for (const HalfSpaceTally* tally : {&result.all, &result.single, &result.multiple}) {
        ASSERT_EQ(tally->strip.size(), 5u);
        const auto column = [&](std::size_t i) { return 0.5 * (tally->grid[8 * 3 + i] + tally->grid[8 * 4 + i]); };
        const std::vector<double> expected{0.5 * (column(0) + column(1)), column(2), column(3), column(4),
                                           (column(5) + column(6) + column(7)) / 3};
        // The same counts divided by the same areas.
        for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(tally->strip[i], expected[i], 1e-12 * expected[i]) << i;
    }
    // Standard errors of what a beam moves: more on the side that it leans to.
    EXPECT_GT(result.all.strip[3] - result.all.strip[2], 3 * result.all.strip_standard_error[3]);
}

// A walk scattered once, at length t of the beam, leaves from under its place: at matched indices and isotropic
// scattering <x> = sin int (mu/(mu+m))^2 dmu / int mu/(mu+m) dmu, m the cosine of the beam, over [0, 1].
TEST(HalfSpace, SingleScatteringShiftsByItsClosedForm) {
    Judge judge;
    std::uint64_t seed = 5;
    for (const double albedo : {0.3, 0.9})
        for (const double angle_deg : {10.0, 45.0, 60.0, 85.0}) {
            HalfSpaceProblem problem = ofAlbedo(albedo);
            problem.angle_deg = angle_deg;
            const HalfSpaceResult result = walk(problem, 200'000, seed++);
            const double m = std::cos(angle_deg * std::numbers::pi / 180), log = std::log((1 + m) / m);
            const double expected = std::sqrt(1 - m * m) * (1 - 2 * m * log + m / (1 + m)) / (1 - m * log);
            judge.compare("angle " + std::to_string(angle_deg), result.single.mean_x_mm, expected);
        }
    judge.expectAgreement();
}

TEST(HalfSpace, RefusesImpossibleStrips) {
    Observer observer;
    HalfSpaceOptions o = options(100);
    o.strip_half_width_mm = 0;
    EXPECT_THROW(walkHalfSpace(problems[0], o, observer), Error);
    o = options(100);
    o.strip_edges_mm = {0, 0};
    EXPECT_THROW(walkHalfSpace(problems[0], o, observer), Error);
}

TEST(HalfSpace, Avx2AndAvx512AgreeBitForBit) {
    if (!hasInstructionSet(HWY_AVX3)) GTEST_SKIP() << "no AVX-512 here";
    for (const HalfSpaceProblem& problem : problems) {
        const HalfSpaceResult wide = onTarget(HWY_AVX3, problem, 200'000),
                              narrow = onTarget(HWY_AVX2, problem, 200'000);
        EXPECT_EQ(wide.instruction_set, "AVX3");
        EXPECT_EQ(narrow.instruction_set, "AVX2");
        EXPECT_EQ(numbers(wide), numbers(narrow));
    }
    // Long walks draw from a generator that all lanes share.
    const HalfSpaceProblem conservative{.sigma_a = 0, .sigma_s = 1};
    EXPECT_EQ(numbers(onTarget(HWY_AVX3, conservative, 600)), numbers(onTarget(HWY_AVX2, conservative, 600)));
}

// Without fused multiply-adds the walks differ in the last bits; another seed makes the samples independent. Standard
// errors: 0.4 % of a total and 1 to 3 % of a bin with SSE4, four times that with emulated lanes, which are slow.
TEST(HalfSpace, TargetsWithoutFusedMultiplyAddAgreeStatistically) {
    for (const std::int64_t target : {HWY_SSE4, HWY_EMU128}) {
        if (target == HWY_SSE4 && !hasInstructionSet(HWY_SSE4)) continue;
        const std::uint64_t walks = target == HWY_SSE4 ? 100'000 : 5'000;
        Judge judge;
        for (const HalfSpaceProblem& problem : problems) {
            Observer observer;
            HalfSpaceOptions o = options(100'000);
            o.seed = 77;
            const HalfSpaceTally a = walkHalfSpace(problem, o, observer).all, b = onTarget(target, problem, walks).all;
            judge.compare("total", {b.total.mean, std::hypot(a.total.standard_error, b.total.standard_error), 0},
                          a.total.mean);
            judge.compare("x",
                          {b.mean_x_mm.mean, std::hypot(a.mean_x_mm.standard_error, b.mean_x_mm.standard_error), 0},
                          a.mean_x_mm.mean);
            for (std::size_t i = 0; i < a.Rd.size(); ++i) {
                const double exits = std::pow(a.Rd[i] / a.standard_error[i], 2) * static_cast<double>(walks) / 1e5;
                judge.compare("Rd", {b.Rd[i], std::hypot(a.standard_error[i], b.standard_error[i]), 0}, a.Rd[i], exits);
            }
        }
        judge.expectAgreement();
    }
}

TEST(HalfSpace, TotalDoesNotDependOnEdgesAndWhatTheyMissIsKeptApart) {
    Observer observer;
    const HalfSpaceProblem& problem = problems[1];
    HalfSpaceOptions inner = options(100'000), outer = inner;
    inner.edges_mm = {0.2, 0.5};
    outer.edges_mm = {0, 1000};
    const HalfSpaceResult a = walkHalfSpace(problem, inner, observer), b = walkHalfSpace(problem, outer, observer);
    EXPECT_EQ(a.all.total.mean, b.all.total.mean);
    EXPECT_EQ(b.all.beyond.at(0), 0);
    const double area = std::numbers::pi * (0.25 - 0.04);
    // Sums of counts, each exact; what is left is the rounding of a few operations.
    EXPECT_NEAR(a.all.beyond.at(0) + a.all.Rd[0] * area, a.all.total.mean, 1e-14);
}

TEST(HalfSpace, SingleAndMultipleAddUpToAll) {
    Observer observer;
    for (const HalfSpaceProblem& problem : problems) {
        const HalfSpaceResult r = walkHalfSpace(problem, options(50'000), observer);
        EXPECT_NEAR(r.single.total.mean + r.multiple.total.mean, r.all.total.mean, 1e-14);
        for (std::size_t i = 0; i < r.all.Rd.size(); ++i)
            EXPECT_NEAR(r.single.Rd[i] + r.multiple.Rd[i], r.all.Rd[i], 1e-12 * (1 + r.all.Rd[i]));
        EXPECT_GT(r.single.total.mean, 0);
    }
}

// R(lambda r; sigma / lambda) = R / lambda^2. A power of two changes no digit on the way.
TEST(HalfSpace, ScalingLengthsByTwoScalesRdByAQuarterExactly) {
    Observer observer;
    for (HalfSpaceProblem problem : problems) {
        HalfSpaceOptions o = options(50'000);
        const HalfSpaceResult small = walkHalfSpace(problem, o, observer);
        problem.sigma_a /= 2;
        problem.sigma_s /= 2;
        o.grid_extent_mm *= 2;
        for (double& edge : o.edges_mm) edge *= 2;
        const HalfSpaceResult large = walkHalfSpace(problem, o, observer);
        EXPECT_EQ(large.all.total.mean, small.all.total.mean);
        EXPECT_EQ(large.all.mean_x_mm.mean, 2 * small.all.mean_x_mm.mean);
        for (std::size_t i = 0; i < small.all.Rd.size(); ++i) EXPECT_EQ(4 * large.all.Rd[i], small.all.Rd[i]);
        for (std::size_t i = 0; i < small.all.grid.size(); ++i) EXPECT_EQ(4 * large.all.grid[i], small.all.grid[i]);
    }
}

TEST(HalfSpace, GridHoldsWhatTheRadialBinsHold) {
    Observer observer;
    HalfSpaceOptions o = options(200'000);
    o.grid = 64;
    o.grid_extent_mm = 200;  // everything
    const HalfSpaceResult r = walkHalfSpace(problems[0], o, observer);
    double flux = 0, x = 0;
    const double side = 2 * o.grid_extent_mm / o.grid;
    for (int row = 0; row < o.grid; ++row)
        for (int col = 0; col < o.grid; ++col) {
            const double cell = r.all.grid[static_cast<std::size_t>(row * o.grid + col)] * side * side;
            flux += cell;
            x += cell * ((col + 0.5) * side - o.grid_extent_mm);
        }
    EXPECT_NEAR(flux, r.all.total.mean, 1e-12);
    EXPECT_NEAR(x / flux, r.all.mean_x_mm.mean, 0.5 * side);
    // An oblique beam leaves off centre: the columns to the right of the entry hold more than those to the left.
    EXPECT_GT(r.all.mean_x_mm.mean, 20 * r.all.mean_x_mm.standard_error);
}

// The first two moments of single scattering at normal incidence and index 1: depth t, r = t tan, so by symmetry the
// mean x is 0. Oblique, the beam meets depth t at x = t tan_beam, and isotropic scattering adds nothing on average.
TEST(HalfSpace, SingleScatteringShiftsByTheMeanDepthTimesTheTangent) {
    const double angle = 60;
    HalfSpaceProblem problem = ofAlbedo(0.5);
    problem.angle_deg = angle;
    // With m = cos 60 deg and mu the cosine of the way out: weight exp(-s (1 + m / mu)) along the beam; mean path s by
    // midpoint quadrature over mu.
    const double m = 0.5;
    double weight = 0, path = 0;
    for (int i = 0; i < 100'000; ++i) {
        const double mu = (i + 0.5) / 100'000, k = 1 + m / mu;
        weight += 1 / k;
        path += 1 / (k * k);
    }
    const double truth = path / weight * std::sin(angle * std::numbers::pi / 180);
    Judge judge;
    judge.compare("mean x", walk(problem, 1e6, 3).single.mean_x_mm, truth);
    judge.expectAgreement();
}

TEST(HalfSpace, BeyondTheCriticalAngleEverythingIsReflected) {
    Observer observer;
    const HalfSpaceProblem problem{.sigma_a = 0.1, .sigma_s = 1, .eta = 0.8, .angle_deg = 54};
    const HalfSpaceResult r = walkHalfSpace(problem, options(1000), observer);
    EXPECT_EQ(r.specular, 1);
    EXPECT_EQ(r.all.total.mean, 0);
    EXPECT_EQ(r.all.total.standard_error, 0);
    EXPECT_EQ(r.all.Rd, std::vector<double>(5, 0.0));
    EXPECT_EQ(r.all.grid, std::vector<double>(64, 0.0));
    HalfSpaceProblem inside = problem;
    inside.angle_deg = 53;
    EXPECT_GT(walkHalfSpace(inside, options(1000), observer).all.total.mean, 0);
}

TEST(HalfSpace, WithoutScatteringNothingIsWalked) {
    Observer observer;
    const HalfSpaceResult r = walkHalfSpace({.sigma_a = 1, .sigma_s = 0, .eta = 1.5}, options(1000), observer);
    EXPECT_NEAR(r.specular, 0.04, 1e-15);
    EXPECT_EQ(r.all.total.mean, 0);
    EXPECT_EQ(r.collisions, 0u);
}

TEST(HalfSpace, SpecularFollowsFresnel) {
    Observer observer;
    const auto specular = [&](double eta, double angle) {
        return walkHalfSpace({.sigma_a = 1, .sigma_s = 0, .eta = eta, .angle_deg = angle}, options(1), observer)
            .specular;
    };
    EXPECT_EQ(specular(1, 75), 0);
    // Brewster's angle leaves the s half: ((eta^2 - 1) / (eta^2 + 1))^2 / 2.
    const double brewster = std::atan(1.5) * 180 / std::numbers::pi;
    EXPECT_NEAR(specular(1.5, brewster), 0.5 * std::pow(1.25 / 3.25, 2), 1e-14);
    EXPECT_NEAR(specular(0.8, 0), std::pow(0.2 / 1.8, 2), 1e-15);
    EXPECT_GT(specular(1.5, 89.9), 0.98);
}

// One exit in 1,000 walks is the least that a bin can have, so an empty bin is known no better than that.
TEST(HalfSpace, EmptyBinHasTheStandardErrorOfOneExit) {
    Observer observer;
    HalfSpaceOptions o = options(1000);
    o.edges_mm = {0, 1000, 1001};
    const HalfSpaceResult r = walkHalfSpace(problems[1], o, observer);
    EXPECT_EQ(r.all.Rd[1], 0);
    const double area = std::numbers::pi * (1001. * 1001. - 1e6);
    EXPECT_NEAR(r.all.standard_error[1] * area, (1 - r.specular) / 1000, 1e-15);
}

// The first collision absorbs all but 1e-9 of the walks, so collisions count them.
TEST(HalfSpace, ExactlyTheWalksAskedForAreWalked) {
    Observer observer;
    for (const std::uint64_t walks : {1, 2, 63, 64, 65, 1000, 4'194'305}) {
        const HalfSpaceResult result = walkHalfSpace({.sigma_a = 1, .sigma_s = 1e-9}, options(walks), observer);
        EXPECT_EQ(result.walks, walks);
        EXPECT_EQ(result.collisions, walks);
    }
}

struct Recorder : Observer {
    void progress(std::string_view, std::uint64_t done_walks, std::uint64_t total, std::string_view unit) override {
        EXPECT_EQ(unit, "walks");
        EXPECT_LE(done_walks, total);
        most = std::max(most.load(), done_walks);
        ++calls;
    }
    bool cancelled() const override { return calls >= stop_after; }

    std::atomic<std::uint64_t> most = 0;
    std::atomic<int> calls = 0;
    int stop_after = 1 << 30;
};

TEST(HalfSpace, ProgressReachesAllWalks) {
    Recorder recorder;
    HalfSpaceOptions o = options(128'000);
    o.threads = 1;
    walkHalfSpace(problems[0], o, recorder);
    EXPECT_EQ(recorder.most, 128'000u);
    EXPECT_EQ(recorder.calls, 64);
}

TEST(HalfSpace, CancelsBetweenChunks) {
    Recorder recorder;
    recorder.stop_after = 3;
    HalfSpaceOptions o = options(100'000);
    o.threads = 1;
    try {
        walkHalfSpace(problems[0], o, recorder);
        FAIL() << "was not cancelled";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind, ErrorKind::interrupted);
    }
    EXPECT_EQ(recorder.calls, 3);
}

void expectRejected(const HalfSpaceProblem& problem, const HalfSpaceOptions& o, const std::string& message) {
    Observer observer;
    try {
        walkHalfSpace(problem, o, observer);
        FAIL() << "accepted, expected: " << message;
    } catch (const Error& error) {
        EXPECT_EQ(error.kind, ErrorKind::input);
        EXPECT_THAT(error.what(), HasSubstr(message));
    }
}

TEST(HalfSpace, RejectsImpossibleProblems) {
    const HalfSpaceOptions o = options(10);
    expectRejected({.sigma_a = -1}, o, "sigma_a is -1 (0 to 1e9 1/mm)");
    expectRejected({.sigma_s = std::nan("")}, o, "sigma_s is nan");
    expectRejected({.g = 1}, o, "g is 1 (above -1 and below 1)");
    expectRejected({.eta = 0}, o, "eta is 0");
    expectRejected({.angle_deg = 90}, o, "the angle of incidence is 90");
    expectRejected({}, options(0), "at least one walk");
}

TEST(HalfSpace, RejectsImpossibleTallies) {
    HalfSpaceOptions o = options(10);
    o.edges_mm = {1};
    expectRejected({}, o, "at least 2 edges");
    o.edges_mm = {-1, 1};
    expectRejected({}, o, "the first edge is -1");
    o.edges_mm = {0, 1, 1};
    expectRejected({}, o, "an edge is 1 (edges ascend");
    o.edges_mm = {0, std::nan("")};
    expectRejected({}, o, "an edge is nan");
    o.edges_mm = {0, 1};
    o.grid = -1;
    expectRejected({}, o, "the grid is -1");
    o.grid = 4;
    o.grid_extent_mm = 0;
    expectRejected({}, o, "the extent of the grid is 0");
}

}  // namespace
}  // namespace searchlight
