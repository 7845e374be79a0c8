#include "transport/slab/slab.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hwy/highway.h>

#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <tuple>

#include "base/csv.h"
#include "base/error.h"
#include "base/files.h"
#include "instruction_sets.h"
#include "judge.h"
#include "transport/half_space/half_space.h"
#include "transport/slab/slab_entry.h"
#include "transport/slab/slab_walk.h"

namespace searchlight {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

SlabOptions options(std::uint64_t walks, double depth_mm = 4) {
    SlabOptions o;
    o.walks = walks;
    o.edges_mm = {0, 0.1, 0.3, 1, 3};
    o.angles = 6;
    o.depths = 8;
    o.depth_mm = depth_mm;
    o.maps = true;
    return o;
}

// The problem of MCML's manual: matched indices inside, 1 cm = 10 mm.
SlabProblem threeLayers() { return {1, 1, {{1.37, 0.1, 10, 0.9, 1}, {1.37, 0.1, 1, 0, 1}, {1.37, 0.2, 1, 0.7, 2}}}; }

// Every kind of interface: glass above and below, a gap between, an index that falls and one that rises.
SlabProblem glassAndGap(double angle_deg) {
    return {1,
            1.33,
            {{1.5, 0, 0, 0, 1}, {1.4, 0.05, 4, 0.8, 0.7}, {1, 0, 0, 0, 0.2}, {1.3, 0.3, 2, 0, 1}, {1.5, 0, 0, 0, 0.5}},
            angle_deg};
}

SlabResult walk(const SlabProblem& problem, const SlabOptions& o) {
    Observer observer;
    return walkSlab(problem, o, observer);
}

// Every number, as one list: equal lists mean equal results, bit for bit.
std::vector<double> numbers(const SlabResult& r) {
    std::vector<double> all{r.specular, static_cast<double>(r.walks), static_cast<double>(r.collisions)};
    for (const Estimate& e : {r.R, r.R_single, r.R_multiple, r.R_unscattered, r.T, r.T_unscattered, r.A})
        all.insert(all.end(), {e.mean, e.standard_error});
    for (const Estimate& e : r.A_layer) all.insert(all.end(), {e.mean, e.standard_error});
    for (const SlabSeries* s : {&r.R_r, &r.R_r_single, &r.R_r_multiple, &r.T_r, &r.R_a, &r.T_a, &r.A_z, &r.fluence_z,
                                &r.R_ra, &r.T_ra, &r.A_rz, &r.fluence_rz})
        for (const auto* list : {&s->mean, &s->standard_error})
            for (const double value : *list) all.push_back(std::isnan(value) ? -1 : value);
    all.insert(all.end(), r.flux.begin(), r.flux.end());
    return all;
}

SlabResult onTarget(std::int64_t target, const SlabProblem& problem, std::uint64_t walks) {
    hwy::SetSupportedTargetsForTest(target);
    const SlabResult result = walk(problem, options(walks));
    hwy::SetSupportedTargetsForTest(0);
    return result;
}

const std::vector<SlabProblem>& problems() {
    static const std::vector<SlabProblem> list{
        threeLayers(), glassAndGap(0), glassAndGap(60), {1, 1, {{1.5, 0.1, 2, 0, infinity}}, 0}};
    return list;
}

// tests/data/transport/slabs.csv. Power: standard errors are 0.1 % to 0.5 % of R and T.
TEST(Slab, AgreesWithAddingDoubling) {
    const std::map<std::string, SlabProblem> slabs{{"vdH_MCML_slab", {1, 1, {{1, 1, 9, 0.75, 0.2}}}},
                                                   {"vdH_iso_t1_a1", {1, 1, {{1, 0, 1, 0, 1}}}},
                                                   {"vdH_hg05_t1_a1", {1, 1, {{1, 0, 1, 0.5, 1}}}},
                                                   {"vdH_hg05_t1_a09", {1, 1, {{1, 0.1, 0.9, 0.5, 1}}}},
                                                   {"vdH_iso_mu05_t1_a099", {1, 1, {{1, 0.01, 0.99, 0, 1}}, 60}},
                                                   {"vdH_hg05_mu05_t4_a099", {1, 1, {{1, 0.01, 0.99, 0.5, 4}}, 60}},
                                                   {"MCML_3layer_n137", threeLayers()}};
    const std::filesystem::path path = std::filesystem::path(SEARCHLIGHT_SOURCE_DIR) / "tests/data/transport/slabs.csv";
    const CsvTable table = parseCsv(readFile(path), "slabs.csv");
    const auto number = [&](std::size_t row, const char* column) {
        return table.number(row, table.find(column).value());
    };
    Judge judge;
    for (std::size_t row = 0; row < table.rows.size(); ++row) {
        const std::string& name = table.rows[row][0].text;
        SlabOptions o = options(1'000'000);
        o.maps = false;
        o.seed = 1000 + row;
        const SlabResult r = walk(slabs.at(name), o);
        EXPECT_NEAR(r.specular, number(row, "R_specular"), 1e-9) << name;
        judge.compare(name + " R", r.R, number(row, "R_diffuse"));
        judge.compare(name + " T", r.T, number(row, "T_diffuse"));
        const double collimated = number(row, "T_collimated");
        judge.compare(name + " T unscattered", r.T_unscattered, collimated, 1e6 * collimated);
        if (number(row, "absorbed") > 1e-9) judge.compare(name + " A", r.A, number(row, "absorbed"));
    }
    judge.expectAgreement();
}

// The same medium cut into layers, matched inside and mismatched outside.
TEST(Slab, AnInfiniteLayerAgreesWithTheHalfSpaceWalk) {
    Observer observer;
    Judge judge;
    for (const HalfSpaceProblem& problem :
         {HalfSpaceProblem{.sigma_a = 0.1, .sigma_s = 0.9, .g = 0, .eta = 1.5, .angle_deg = 0},
          HalfSpaceProblem{.sigma_a = 0.1, .sigma_s = 5, .g = 0.8, .eta = 1.3, .angle_deg = 50}}) {
        HalfSpaceOptions half;
        half.walks = 2'000'000;
        half.seed = 5;
        half.edges_mm = options(1).edges_mm;
        const HalfSpaceResult a = walkHalfSpace(problem, half, observer);
        const SlabLayer whole{problem.eta, problem.sigma_a, problem.sigma_s, problem.g, infinity};
        SlabLayer top = whole, next = whole;
        top.thickness_mm = 0.5;
        next.thickness_mm = 1.1;
        for (const std::vector<SlabLayer>& layers : {std::vector{whole}, std::vector{top, next, whole}}) {
            SlabOptions o = options(1'000'000);
            o.seed = 6 + layers.size();
            const SlabResult b = walk({1, 1, layers, problem.angle_deg}, o);
            EXPECT_NEAR(b.specular, a.specular, 1e-14);
            const auto compare = [&](const char* what, const Estimate& mine, const Estimate& theirs) {
                judge.compare(what, {mine.mean, std::hypot(mine.standard_error, theirs.standard_error), 0},
                              theirs.mean);
            };
            compare("R", b.R, a.all.total);
            compare("single", b.R_single, a.single.total);
            compare("multiple", b.R_multiple, a.multiple.total);
            for (std::size_t i = 0; i < a.all.Rd.size(); ++i) {
                compare("R(r)", {b.R_r.mean[i], b.R_r.standard_error[i], 0}, {a.all.Rd[i], a.all.standard_error[i], 0});
                compare("R(r) single", {b.R_r_single.mean[i], b.R_r_single.standard_error[i], 0},
                        {a.single.Rd[i], a.single.standard_error[i], 0});
            }
        }
    }
    judge.expectAgreement();
}

// Each walk ends exactly once. Counts are exact; what is left is the rounding of a few operations.
TEST(Slab, ReflectedTransmittedAndAbsorbedAddUpToOne) {
    for (const SlabProblem& problem : problems()) {
        const SlabResult r = walk(problem, options(50'000));
        EXPECT_NEAR(r.specular + r.R.mean + r.R_unscattered.mean + r.T.mean + r.T_unscattered.mean + r.A.mean, 1,
                    1e-13);
        EXPECT_NEAR(r.R_single.mean + r.R_multiple.mean, r.R.mean, 1e-14);
        double layers = 0;
        for (const Estimate& layer : r.A_layer) layers += layer.mean;
        EXPECT_NEAR(layers, r.A.mean, 1e-14);
    }
}

TEST(Slab, EachChunkConservesEnergyExactly) {
    const SlabProblem problem = threeLayers();
    const SlabLayout layout = slabLayout(problem, options(1));
    SlabWalk chunk;
    for (const SlabLayer& layer : problem.layers) {
        const double sigma_t = layer.sigma_a + layer.sigma_s;
        chunk.layers.push_back({1 / sigma_t, layer.sigma_a / sigma_t, 1, layer.g, layer.thickness_mm, 1, 1});
    }
    for (std::uint64_t walks : {1u, 3u, 63u, 65u, 1000u}) {
        SlabTally tally(layout);
        walkSlabChunk(chunk, 1, walks, walks, tally);
        double ends = 0;
        for (const auto run : {SlabLayout::R_scattered, SlabLayout::R_unscattered, SlabLayout::T_scattered,
                               SlabLayout::T_unscattered, SlabLayout::A_total})
            ends += tally.flux()[layout.first(run)];
        EXPECT_EQ(ends, static_cast<double>(walks));
    }
}

TEST(Slab, SeriesAndMapsIntegrateToTheTotals) {
    SlabProblem problem = threeLayers();
    SlabOptions o = options(1'000'000);
    o.edges_mm = {0, 0.5, 1000};
    const SlabResult r = walk(problem, o);
    const double areas[] = {std::numbers::pi * 0.25, std::numbers::pi * (1e6 - 0.25)};
    EXPECT_NEAR(r.R_r.mean[0] * areas[0] + r.R_r.mean[1] * areas[1], r.R.mean, 1e-12);
    EXPECT_NEAR(r.T_r.mean[0] * areas[0] + r.T_r.mean[1] * areas[1], r.T.mean, 1e-12);
    double R = 0, R_map = 0, A = 0, A_map = 0, fluence = 0;
    for (std::size_t i = 0; i < 6; ++i) {
        const double low = std::cos(i * std::numbers::pi / 12), high = std::cos((i + 1) * std::numbers::pi / 12);
        R += r.R_a.mean[i] * 2 * std::numbers::pi * (low - high);
        for (std::size_t row = 0; row < 2; ++row)
            R_map += r.R_ra.mean[row * 6 + i] * areas[row] * std::numbers::pi * (low * low - high * high);
    }
    for (std::size_t i = 0; i < 8; ++i) {
        A += r.A_z.mean[i] * 0.5;
        for (std::size_t row = 0; row < 2; ++row) A_map += r.A_rz.mean[row * 8 + i] * areas[row] * 0.5;
        fluence += r.fluence_z.mean[i] * 0.5 * (i < 4 ? 0.1 : 0.2);
    }
    EXPECT_NEAR(R, r.R.mean, 1e-12);
    EXPECT_NEAR(R_map, r.R.mean, 1e-12);
    // Collisions and absorptions agree on average, known to 0.1 %; no bin is cut by an interface, so fluence and
    // absorption agree exactly.
    EXPECT_NEAR(A, r.A.mean, 5 * r.A.standard_error);
    EXPECT_NEAR(A_map, A, 1e-12);
    EXPECT_NEAR(fluence, A, 1e-12);
}

// Without scattering, Beer's law between two surfaces: r = ((n-1)/(n+1))^2, t = exp(-tau); 4e-4 of standard error sees
// a missing internal reflection (0.9 %).
TEST(Slab, APureAbsorberFollowsBeersLawWithReflections) {
    const double r = std::pow(0.5 / 2.5, 2), t = std::exp(-1.0);
    Judge judge;
    const SlabResult result = walk({1, 1, {{1.5, 1, 0, 0, 1}}}, options(1'000'000));
    const double transmitted = (1 - r) * (1 - r) * t / (1 - r * r * t * t);
    judge.compare("T", result.T_unscattered, transmitted);
    judge.compare("R", result.R_unscattered, (1 - r) * t * r * t * (1 - r) / (1 - r * r * t * t));
    judge.expectAgreement();
    EXPECT_EQ(result.R.mean + result.T.mean, 0);
}

TEST(Slab, ClearLayersAloneAreExact) {
    const SlabResult glass = walk({1, 1, {{1.5, 0, 0, 0, 1}}}, options(100));
    EXPECT_NEAR(glass.specular, 2 * 0.04 / 1.04, 1e-15);  // 2 r / (1 + r)
    EXPECT_NEAR(glass.T_unscattered.mean, 1 - 2 * 0.04 / 1.04, 1e-15);
    EXPECT_EQ(glass.T_unscattered.standard_error, 0);
    EXPECT_EQ(glass.R_r.standard_error[0], 0);
    const SlabResult thinner = walk({1.5, 1, {{1, 0.1, 1, 0, 1}}, 60}, options(100));
    EXPECT_EQ(thinner.specular, 1);  // total reflection
}

// The glass above shifts an oblique beam by d tan(refracted angle) and, after two more reflections, by three times
// that; a medium that absorbs at once shows where.
TEST(Slab, GlassShiftsAnObliqueBeam) {
    const double tangent = std::tan(std::asin(std::sin(std::numbers::pi / 3) / 1.5));
    SlabOptions o = options(200'000);
    o.edges_mm = {0, tangent - 0.01, tangent + 0.01, 3 * tangent - 0.01, 3 * tangent + 0.01};
    o.depth_mm = 2;
    const SlabResult r = walk({1, 1, {{1.5, 0, 0, 0, 1}, {2.5, 1000, 0, 0, infinity}}, 60}, o);
    const auto absorbed = [&](std::size_t annulus) {
        double sum = 0;
        for (std::size_t i = 0; i < 8; ++i) sum += r.A_rz.mean[annulus * 8 + i];
        const double low = o.edges_mm[annulus], high = o.edges_mm[annulus + 1];
        return sum * 0.25 * std::numbers::pi * (high * high - low * low);
    };
    EXPECT_EQ(absorbed(0), 0);
    EXPECT_GT(absorbed(1), 0.9 * r.A.mean);
    EXPECT_EQ(absorbed(2), 0);
    EXPECT_GT(absorbed(3), 0);
    EXPECT_NEAR(absorbed(1) + absorbed(3), r.A.mean, 1e-3);
}

// Against beams that are followed one by one, those that do not enter thrown away.
TEST(EntryShift, IsThatOfBeamsThatEnter) {
    const std::vector<EntryShift::Surface> surfaces{{0.3, 1}, {0.6, 10}, {0.2, 0.1}, {0.5, 0}};
    const auto followed = [&](SplitMix64& random) {
        for (;;) {
            double shift = 0;
            int next = 0;
            for (bool down = true;;) {
                if (random.uniform() < surfaces[static_cast<std::size_t>(next)].reflectance) down = !down;
                next += down ? 1 : -1;
                if (next < 0) break;
                if (next == 4) return shift;
                shift += surfaces[static_cast<std::size_t>(down ? next - 1 : next)].shift_mm;
            }
        }
    };
    const EntryShift entry(surfaces);
    ASSERT_TRUE(entry.moves());
    constexpr int count = 400'000;
    SplitMix64 random = streamOf(1, 0), other = streamOf(1, 1);
    Estimate a, b, a2, b2;
    Judge judge;
    const auto moments = [](const auto& draw) {
        std::array<double, 3> sums{};  // of the first, second and fourth power
        for (int i = 0; i < count; ++i) {
            const double s = draw();
            sums[0] += s, sums[1] += s * s, sums[2] += s * s * s * s;
        }
        for (double& sum : sums) sum /= count;
        return std::pair{Estimate{sums[0], std::sqrt((sums[1] - sums[0] * sums[0]) / count), count},
                         Estimate{sums[1], std::sqrt((sums[2] - sums[1] * sums[1]) / count), count}};
    };
    std::tie(a, a2) = moments([&] { return entry.draw(random); });
    std::tie(b, b2) = moments([&] { return followed(other); });
    judge.compare("mean", {a.mean - b.mean, std::hypot(a.standard_error, b.standard_error), count}, 0);
    judge.compare("mean square", {a2.mean - b2.mean, std::hypot(a2.standard_error, b2.standard_error), count}, 0);
    judge.expectAgreement();
}

TEST(EntryShift, EndsCloseToTotalReflection) {
    SplitMix64 random = streamOf(1, 0);
    double sum = 0;
    const EntryShift entry(std::vector<EntryShift::Surface>{{0.5, 1}, {1 - 1e-15, 0}});
    constexpr int count = 100'000;
    for (int i = 0; i < count; ++i) sum += entry.draw(random);
    EXPECT_NEAR(sum / count, 3, 0.05);  // 1 + 2 r / (1 - r)
}

// What the lower surface reflects totally is specular, whatever rounding makes of the sum.
TEST(Slab, NothingEntersThroughGlassUnderTotalReflection) {
    for (int i = 0; i < 400; ++i) {
        const double angle = 46 + 0.1 * i;  // from 1.4 into 1: beyond 45.6 degrees
        const SlabResult r = walk({1.4, 1, {{1.5, 0, 0, 0, 1}, {1, 0, 1, 0, 1}}, angle}, options(100));
        ASSERT_EQ(r.specular, 1) << angle;
        ASSERT_EQ(r.R.mean, 0) << angle;
    }
}

// Scattered light adds to the beam just below the surface, and fades with depth.
TEST(Slab, FluenceBelowASurfaceExceedsThatOfTheBeam) {
    const SlabResult r = walk({1, 1, {{1.37, 0.1, 10, 0.9, infinity}}}, options(200'000));
    EXPECT_GT(r.fluence_z.mean[0], 1);
    EXPECT_LT(r.fluence_z.mean[7], r.fluence_z.mean[0]);
}

TEST(Slab, ResultDoesNotDependOnThreads) {
    for (const SlabProblem& problem : problems()) {
        SlabOptions o = options(100'000);
        o.threads = 1;
        const SlabResult one = walk(problem, o);
        o.threads = 2;
        EXPECT_EQ(numbers(one), numbers(walk(problem, o)));
        o.seed = 2;
        EXPECT_NE(numbers(one), numbers(walk(problem, o)));
    }
}

TEST(Slab, Avx2AndAvx512AgreeBitForBit) {
    if (!hasInstructionSet(HWY_AVX3)) GTEST_SKIP() << "no AVX-512 here";
    for (const SlabProblem& problem : problems()) {
        const SlabResult wide = onTarget(HWY_AVX3, problem, 100'000), narrow = onTarget(HWY_AVX2, problem, 100'000);
        EXPECT_EQ(wide.instruction_set, "AVX3");
        EXPECT_EQ(narrow.instruction_set, "AVX2");
        EXPECT_EQ(numbers(wide), numbers(narrow));
    }
    // Long walks draw from a generator that all lanes share.
    const SlabProblem conservative{1, 1, {{1, 0, 1, 0, infinity}}};
    EXPECT_EQ(numbers(onTarget(HWY_AVX3, conservative, 600)), numbers(onTarget(HWY_AVX2, conservative, 600)));
}

TEST(Slab, TargetsWithoutFusedMultiplyAddAgreeStatistically) {
    for (const std::int64_t target : {HWY_SSE4, HWY_EMU128}) {
        if (target == HWY_SSE4 && !hasInstructionSet(HWY_SSE4)) continue;
        Judge judge;
        for (const SlabProblem& problem : problems()) {
            SlabOptions o = options(100'000);
            o.seed = 77;
            const SlabResult a = walk(problem, o), b = onTarget(target, problem, target == HWY_SSE4 ? 100'000 : 5'000);
            const auto compare = [&](const char* what, const Estimate& mine, const Estimate& theirs) {
                if (theirs.mean > 0)
                    judge.compare(what, {mine.mean, std::hypot(mine.standard_error, theirs.standard_error), 0},
                                  theirs.mean, 5000 * theirs.mean);
            };
            compare("R", b.R, a.R);
            compare("T", b.T, a.T);
            compare("T unscattered", b.T_unscattered, a.T_unscattered);
            for (std::size_t i = 0; i < a.A_layer.size(); ++i) compare("A", b.A_layer[i], a.A_layer[i]);
        }
        judge.expectAgreement();
    }
}

// Weak, because these walks are long: sees an error of 2 %.
TEST(Slab, WithoutAbsorptionEverythingLeavesAHalfSpace) {
    Judge judge;
    judge.compare("matched", walk({1, 1, {{1, 0, 1, 0, infinity}}}, options(4000)).R, 1);
    judge.expectAgreement();
}

std::string refusal(const SlabProblem& problem, const SlabOptions& o) {
    try {
        walk(problem, o);
    } catch (const Error& error) {
        return error.what();
    }
    return "no error";
}

TEST(Slab, RefusesImpossibleProblems) {
    const SlabOptions o = options(100);
    EXPECT_EQ(refusal({}, o), "a slab needs at least one layer");
    EXPECT_EQ(refusal({0, 1, {{}}}, o), "the refractive index above is 0 (0.1 to 10)");
    EXPECT_EQ(refusal({1, 1, {{1, -1}}}, o), "sigma_a of layer 1 is -1 (0 to 1e9 1/mm)");
    EXPECT_EQ(refusal({1, 1, {{1, 0, 1, 1}}}, o), "g of layer 1 is 1 (above -1 and below 1)");
    EXPECT_EQ(refusal({1, 1, {{1, 0, 1, 0, infinity}, {}}}, o),
              "the thickness of layer 1 is infinite (only the last layer may be)");
    EXPECT_EQ(refusal({1, 1, {{1, 0, 0, 0, infinity}}}, o),
              "layer 1 is infinite and clear (light would never end in it)");
    EXPECT_EQ(refusal({1, 1, {{}}, 90}, o), "the angle of incidence is 90 (0 to below 90 degrees)");
    SlabOptions fine = o;
    fine.angles = 1'000'000;
    EXPECT_EQ(refusal({1, 1, {{}}}, fine),
              "the tallies have more than 4 million cells (fewer radial bins, angles, depths or cells)");
}

}  // namespace
}  // namespace searchlight
