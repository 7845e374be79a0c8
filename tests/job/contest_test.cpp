#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/files.h"
#include "gtest/gtest.h"
#include "job/command.h"
#include "job/contest/contest_plan.h"
#include "job/contest/contest_score.h"
#include "job/contest/standings.h"

namespace searchlight {
namespace {

namespace fs = std::filesystem;

ErrorCurve curve(std::vector<CostPoint> points) { return ErrorCurve(std::move(points)); }

TEST(ErrorCurve, LeavesOutWhatCostsMoreAndIsNoNearer) {
    const ErrorCurve falling = curve({{100, 0.01}, {10, 0.1}, {50, 0.2}, {200, 0.01}});
    ASSERT_EQ(falling.points().size(), 2u);
    EXPECT_EQ(falling.points()[0].ms, 10);
    EXPECT_EQ(falling.points()[1].ms, 100);
}

TEST(ErrorCurve, FallsAlongALineOfLogarithms) {
    const ErrorCurve falling = curve({{10, 0.1}, {1000, 0.001}});
    EXPECT_EQ(falling.errorAt(9.99), std::numeric_limits<double>::infinity());
    EXPECT_NEAR(falling.errorAt(100), 0.01, 1e-15);
    EXPECT_EQ(falling.errorAt(1e6), 0.001);
    EXPECT_NEAR(falling.timeTo(0.01), 100, 1e-10);
    EXPECT_EQ(falling.timeTo(0.5), 10);
    EXPECT_EQ(falling.timeTo(0.0009), std::numeric_limits<double>::infinity());
}

// 1/t from 1 ms on, and 0.1 at once from 2 ms on, which 1/t passes at 10 ms.
TEST(Standings, TheNearestChangesWhereCurvesCross) {
    const std::vector<ErrorCurve> curves{curve({{1, 1}, {1000, 0.001}}), curve({{2, 0.1}})};
    const std::vector<TimeReign> reigns = nearestOverTime(curves, 0);
    ASSERT_EQ(reigns.size(), 3u);
    EXPECT_EQ(reigns[0].curve, 0u);
    EXPECT_EQ(reigns[1].curve, 1u);
    EXPECT_EQ(reigns[2].curve, 0u);
    // To 2 %: the grain of the search.
    EXPECT_NEAR(reigns[0].to_ms, 2, 0.04);
    EXPECT_NEAR(reigns[1].to_ms, 10, 0.2);
    EXPECT_EQ(reigns[0].to_ms, reigns[1].from_ms);
    EXPECT_EQ(reigns[2].to_ms, std::numeric_limits<double>::infinity());
    EXPECT_NEAR(reigns[2].error, 0.001, 1e-12);
}

TEST(Standings, TheFastestChangesWithTheError) {
    const std::vector<ErrorCurve> curves{curve({{1, 1}, {1000, 0.001}}), curve({{2, 0.1}})};
    const std::vector<ErrorReign> reigns = fastestOverError(curves, 0);
    ASSERT_EQ(reigns.size(), 3u);
    // 1/t has 0.5 after 2 ms: from there down to 0.1 the other is faster.
    EXPECT_NEAR(reigns[0].to, 0.5, 0.02);
    EXPECT_EQ(reigns[1].curve, 1u);
    EXPECT_NEAR(reigns[1].to, 0.1, 0.004);
    EXPECT_EQ(reigns[2].curve, 0u);
    EXPECT_NEAR(reigns[2].ms, 1000, 1e-6);
}

TEST(Standings, BelowTheFloorWhoWasThereFirstStays) {
    const std::vector<ErrorCurve> curves{curve({{1, 0.01}}), curve({{5, 0.001}})};
    const std::vector<TimeReign> reigns = nearestOverTime(curves, 0.02);
    ASSERT_EQ(reigns.size(), 1u);
    EXPECT_EQ(reigns[0].curve, 0u);
}

TEST(Standings, NobodyWinsWhereNobodyIs) {
    const std::vector<ErrorCurve> curves{curve({}), curve({})};
    EXPECT_TRUE(nearestOverTime(curves, 0).empty());
    EXPECT_TRUE(fastestOverError(curves, 0).empty());
}

TEST(Standings, AreSaidInWords) {
    const std::vector<std::string> labels{"a", "b"};
    const std::vector<TimeReign> reigns{{0, 1, 20, 0.1}, {1, 20, 1500, 0.05}, {0, 1500, INFINITY, 0.01}};
    EXPECT_EQ(reignText(reigns, labels), "a below 20 ms, b from there to 1.5 s, a from 1.5 s on");
    EXPECT_EQ(reignText(std::span(reigns).first(1), labels), "a at all times");
    const std::vector<ErrorReign> errors{{0, 0.5, 0.02, 12}, {1, 0.02, 0.001, 2100}};
    EXPECT_EQ(reignText(errors, labels), "a down to 2 % (12 ms), b on to 0.1 % (2.1 s)");
}

TEST(JudgedError, TheReferencesNoiseIsTakenOut) {
    const JudgedError error = judged(0.05, 0.03);
    EXPECT_NEAR(error.error, 0.04, 1e-15);
    EXPECT_TRUE(error.resolved);
    EXPECT_LT(error.lower, error.error);
    EXPECT_GT(error.upper, error.error);
    // As large as the noise: it may be 0, and is at most sqrt(0.52) of it.
    const JudgedError none = judged(0.03, 0.03);
    EXPECT_EQ(none.error, 0);
    EXPECT_FALSE(none.resolved);
    EXPECT_NEAR(none.upper, 0.03 * std::sqrt(0.52), 1e-15);
}

Job quickJob() {
    Job job;
    job.command = "contest";
    job.scene.scale = 10;
    job.options = {{"size", std::string("16x12")}, {"points", std::string("400")}, {"walks", 0.0}};
    return job;
}

TEST(ContestPlan, EveryTechniqueOfTheRegistryTakesPart) {
    Job job = quickJob();
    job.options["budgets"] = std::string("2");
    const ContestPlan plan = contestPlan(job, true);
    ASSERT_EQ(plan.contestants.size(), techniques().size());
    for (std::size_t i = 0; i < techniques().size(); ++i) {
        EXPECT_EQ(plan.contestants[i].label, techniques()[i].id);
        EXPECT_LE(plan.contestants[i].cells.size(), 2u);
        for (const ContestCell& cell : plan.contestants[i].cells) EXPECT_EQ(cell.job.command, "render");
    }
    EXPECT_TRUE(plan.left_out.empty());
}

TEST(ContestPlan, BudgetsOfTheRegistryAreValuesOfTheirOptions) {
    for (const TechniqueEntry& entry : techniques()) {
        if (entry.budget.option.empty()) continue;
        EXPECT_GT(entry.budget.values.size(), 1u) << entry.id;
        if (entry.budget.option == "points") continue;
        const Param& param = findParam(entry.options, entry.budget.option, "option");
        for (const double value : entry.budget.values) EXPECT_NO_THROW(checkValue(param, value)) << entry.id;
    }
}

TEST(ContestPlan, ModelsThatReadDirectionsLeaveRadialTechniquesOut) {
    const ContestPlan plan = contestPlan(quickJob(), false);
    for (const Contestant& contestant : plan.contestants) EXPECT_TRUE(contestant.entry->directional);
    EXPECT_FALSE(plan.left_out.empty());
}

TEST(ContestPlan, TechniquesMayTakePartWithOptionsOfTheirOwn) {
    Job job = quickJob();
    job.options["techniques"] = std::string("direct:sampling=area,direct:sampling=probes,direct:spp=8");
    job.options["budgets"] = std::string("direct=2:32");
    const ContestPlan plan = contestPlan(job, true);
    ASSERT_EQ(plan.contestants.size(), 3u);
    EXPECT_EQ(plan.contestants[0].label, "direct, sampling area");
    ASSERT_EQ(plan.contestants[1].cells.size(), 2u);
    EXPECT_EQ(std::get<std::string>(plan.contestants[1].cells[1].job.options.at("sampling")), "probes");
    EXPECT_EQ(std::get<double>(plan.contestants[1].cells[1].job.options.at("spp")), 32);
    // What is set is no budget.
    ASSERT_EQ(plan.contestants[2].cells.size(), 1u);
    EXPECT_EQ(std::get<double>(plan.contestants[2].cells[0].job.options.at("spp")), 8);
}

TEST(ContestPlan, MistakesAreNamed) {
    const auto message = [](const char* option, const char* value, bool radial = true) {
        Job job = quickJob();
        job.options[option] = std::string(value);
        try {
            contestPlan(job, radial);
        } catch (const Error& error) {
            EXPECT_EQ(error.kind, ErrorKind::usage);
            return error.message;
        }
        return std::string();
    };
    EXPECT_EQ(message("techniques", "drect"), "unknown technique 'drect'");
    EXPECT_EQ(message("techniques", "direct:samples=3"), "unknown option of direct 'samples'");
    EXPECT_EQ(message("techniques", "direct:area"), "'area' is no option of a technique");
    EXPECT_EQ(message("techniques", "direct,direct"), "direct takes part twice with the same budget");
    EXPECT_EQ(message("techniques", "local", false),
              "local cannot take part: it takes radial models, and this one reads directions");
    EXPECT_EQ(message("budgets", "direct=0"), "'0' is no budget");
    EXPECT_EQ(message("budgets", "2.5"), "'2.5' is no value for budgets");
    EXPECT_EQ(message("backend", "cuda"), "unknown backend 'cuda'");
    EXPECT_EQ(message("size", "9000x9000"), "9000 x 9000 pixels are too many for a contest");
}

struct Quiet : Observer {
    bool cancelled() const override { return stop; }
    bool stop = false;
};

TEST(Contest, LeavesAPageTablesAndFiguresAndResumes) {
    const fs::path folder = fs::path(testing::TempDir()) / "contest_quick";
    fs::remove_all(folder);
    Job job = quickJob();
    job.output = folder.string();
    job.options["techniques"] = std::string("hierarchical,direct:pass_points=256");
    job.options["budgets"] = std::string("2");
    job.options["walks"] = 3e3;
    job.options["noise"] = 5.0;
    job.options["threads"] = 1.0;
    Quiet observer;
    const nlohmann::json first = nlohmann::json::parse(run(job, observer).json);
    for (const char* file : {"index.html", "contest.csv", "contest.json", "error_over_time.svg",
                             "model_error_over_time.svg", "cells/hierarchical_cpu_0.1.exr", "reference/walks.exr"})
        EXPECT_TRUE(fs::exists(folder / file)) << file;
    ASSERT_EQ(first.at("cells").size(), 4u);
    EXPECT_EQ(first.at("rendered"), 4);
    EXPECT_EQ(first.at("found"), 0);
    for (const auto& cell : first.at("cells")) {
        EXPECT_GT(cell.at("wall_ms").get<double>(), 0);
        // Whatever the technique, it draws the same sphere: noise and grouping leave less than that.
        EXPECT_LT(cell.at("direct").at("error").get<double>(), 0.5);
    }
    EXPECT_TRUE(first.at("references").at("walks").contains("noise"));
    EXPECT_TRUE(first.at("winners").get<std::string>().starts_with("On the CPU the nearest to direct is "));

    // One picture is missing, one is another's: these two are drawn, and the others kept.
    fs::remove(folder / "cells/hierarchical_cpu_0.03.json");
    std::ofstream(folder / "cells/direct_pass_points-256_cpu_1.json") << "{}";
    job.options["resume"] = true;
    const nlohmann::json again = nlohmann::json::parse(run(job, observer).json);
    EXPECT_EQ(again.at("rendered"), 2);
    EXPECT_EQ(again.at("found"), 2);

    observer.stop = true;
    fs::remove(folder / "cells/hierarchical_cpu_0.1.json");
    try {
        run(job, observer);
        ADD_FAILURE();
    } catch (const Error& error) {
        EXPECT_EQ(error.kind, ErrorKind::interrupted);
        EXPECT_EQ(error.message, "interrupted with 0 of 4 pictures done");
    }
    fs::remove_all(folder);
}

TEST(Contest, SaysWhenNoPictureWouldBeDrawn) {
    const fs::path folder = fs::path(testing::TempDir()) / "contest_hasty";
    Job job = quickJob();
    job.output = folder.string();
    job.options["cell_seconds"] = 1e-6;
    Quiet observer;
    try {
        run(job, observer);
        ADD_FAILURE();
    } catch (const Error& error) {
        EXPECT_EQ(error.kind, ErrorKind::usage);
        EXPECT_EQ(error.message, "no picture would be drawn within --cell-seconds 1e-06");
    }
    fs::remove_all(folder);
}

}  // namespace
}  // namespace searchlight
