// Whole profiles by ordinates: seconds of CPU each.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <filesystem>

#include "exact.h"
#include "transport/exact/exact_half_space.h"
#include "transport/exact/ordinate_half_space.h"
#include "transport/half_space/single_scattering.h"

namespace searchlight {
namespace {

constexpr double radii_mfp[] = {0.1, 0.2, 0.3, 0.5, 0.7, 1, 1.5, 2, 3, 5, 7, 10};

// The H function knows this case to 1e-10. What is promised is 1e-4 of R_d from 0.1 to 10 mean free paths.
TEST(OrdinateHalfSpace, MatchesTheHFunction) {
    Observer observer;
    for (const double albedo : {0.5, 0.9, 0.99}) {
        const ExactHalfSpace exact(1 - albedo, albedo);
        const ExactHalfSpace found = solveOrdinates(ofAlbedo(albedo), 0, observer);
        EXPECT_NEAR(found.total().all.mean, exact.total().all.mean, 1e-5) << albedo;
        double worst = 0;
        for (const double r : radii_mfp) {
            const double truth = exact.Rd(r).all.mean;
            const Estimate value = found.Rd(r).all;
            worst = std::max(worst, std::abs(value.mean / truth - 1));
            EXPECT_LT(std::abs(value.mean - truth), value.standard_error) << albedo << " at " << r;
            EXPECT_NEAR(found.Rd(r).single.mean / exact.Rd(r).single.mean, 1, 1e-9) << albedo << " at " << r;
        }
        EXPECT_LT(worst, 1e-4) << albedo;
        RecordProperty(fmt::format("worst_{}", albedo), fmt::format("{:.2e}", worst));
    }
}

// Forward scattering and refraction against the walk that foresees escapes. Power: its standard errors are 0.05 % to
// 0.3 % of a bin.
TEST(OrdinateHalfSpace, WalksAgreeUnderASurface) {
    Observer observer;
    Judge judge;
    std::uint64_t seed = 1;
    for (const HalfSpaceProblem& problem : {HalfSpaceProblem{.sigma_a = 0.032, .sigma_s = 0.74, .eta = 1.3},
                                            HalfSpaceProblem{.sigma_a = 0.1, .sigma_s = 0.9, .g = 0.5, .eta = 1.5},
                                            HalfSpaceProblem{.sigma_a = 0.3, .sigma_s = 0.7, .g = -0.4, .eta = 1.4},
                                            HalfSpaceProblem{.sigma_a = 0.4, .sigma_s = 0.6, .g = 0.3, .eta = 0.8}}) {
        const double mfp = 1 / (problem.sigma_a + (1 - problem.g) * problem.sigma_s);
        std::vector<double> edges = {0};
        for (const double r : radii_mfp) edges.push_back(r * mfp);
        const HalfSpaceResult exact = solveAnyHalfSpace(problem, edges, 0, observer);
        const HalfSpaceResult walked = walk(problem, 1e6, seed++, edges, Estimator::best);
        EXPECT_EQ(exact.specular, walked.specular);
        const auto compare = [&](const std::string& what, const Estimate& mine, const Estimate& truth) {
            judge.compare(fmt::format("g {}, {}", problem.g, what),
                          {mine.mean, std::hypot(mine.standard_error, truth.standard_error), 0}, truth.mean);
        };
        compare("total", walked.all.total, exact.all.total);
        for (std::size_t i = 0; i + 1 < edges.size(); ++i)
            compare(fmt::format("from {}", edges[i]), {walked.all.Rd[i], walked.all.standard_error[i], 0},
                    {exact.all.Rd[i], exact.all.standard_error[i], 0});
    }
    judge.expectAgreement();
}

// Curves of MCML with a sound generator, bins of a tenth of a mean free path.
TEST(OrdinateHalfSpace, AgreesWithMcml) {
    const std::filesystem::path folder = SEARCHLIGHT_SOURCE_DIR "/../shared/data/mcml";
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no " << folder;
    Observer observer;
    Judge judge;
    struct Curve {
        const char* file;
        HalfSpaceProblem problem;
        double total;
    };
    for (const Curve& curve :
         {Curve{"mcml_skin1_red.csv", {.sigma_a = 0.032, .sigma_s = 0.74, .eta = 1.3}, 0.43191455},
          Curve{"mcml_marble_red.csv", {.sigma_a = 0.0021, .sigma_s = 2.19, .eta = 1.5}, 0.80443}}) {
        const CsvTable curve_table = parseCsv(readFile(folder / curve.file), curve.file);
        const double mfp = 1 / (curve.problem.sigma_a + curve.problem.sigma_s);
        std::vector<double> edges;
        for (int i = 0; i <= 100; ++i) edges.push_back(0.1 * mfp * i);
        const HalfSpaceResult exact = solveAnyHalfSpace(curve.problem, edges, 0, observer);
        judge.compare(curve.file, {curve.total, 2e-4, 0}, exact.all.total.mean);
        const std::size_t mean = 1, error = 2;
        for (std::size_t i = 0; i < 100; ++i) {
            const double Rd = curve_table.number(i, mean), relative = curve_table.number(i, error);
            judge.compare(fmt::format("{} bin {}", curve.file, i), {Rd, relative * Rd, 0}, exact.all.Rd[i]);
        }
    }
    judge.expectAgreement();
}

}  // namespace
}  // namespace searchlight
