#include "job/live/live_plot.h"

#include <gmock/gmock.h>

#include <chrono>
#include <cmath>

#include "job/plot/curves.h"
#include "job/plot/subject.h"

namespace searchlight {
namespace {

using testing::HasSubstr;

LiveRequest requestOf(const std::vector<std::string>& models) {
    LiveRequest request;
    int color = 4;
    for (const std::string& id : models) request.models.push_back({.model = {.id = id}, .color = color++});
    request.walks = 2e4;
    return request;
}

const Series& seriesCalled(const Figure& figure, const std::string& label) {
    for (const Series& series : figure.series)
        if (series.label.starts_with(label)) return series;
    throw std::runtime_error("no series " + label);
}

class LivePlotTest : public testing::Test {
protected:
    void SetUp() override { ::setenv("XDG_CACHE_HOME", (testing::TempDir() + "live_plot_cache").c_str(), 1); }

    Engine engine_;
    LivePlot plot_{engine_};
    Observer observer_;
};

TEST_F(LivePlotTest, DrawsTheCurvesOfThePlotCommandInTheColoursOfTheSlots) {
    const LiveRequest request = requestOf({"dipole", "better_dipole"});
    const LivePlotResult result = plot_.draw(request, LiveDetail::fine);
    EXPECT_TRUE(result.problems.empty());
    ASSERT_EQ(result.figure.series.size(), 2u);
    EXPECT_EQ(result.figure.series[0].color, 4);
    EXPECT_EQ(result.figure.series[1].color, 5);
    const Medium medium = resolveMaterial(request.material).medium;
    LoadedModel dipole = engine_.load("dipole", {}, "auto", medium);
    const Series& series = result.figure.series[0];
    const PencilCurve curve = modelCurve(dipole, 0, series.x, {});
    for (std::size_t i = 0; i < series.y.size(); ++i) EXPECT_EQ(series.y[i], curve.Rd[i].r);
}

// One medium for all curves and the reference, whichever model inverts it; what a slot has of its own it inverts
// itself.
TEST_F(LivePlotTest, RdrAndLdStandForOneMediumThatOneModelInverts) {
    LiveRequest request = requestOf({"dipole", "better_dipole", "dipole"});
    request.material = {.id = "", .Rdr = {0.5}, .ld = {1}};
    request.inverted_by = {.id = "better_dipole"};
    request.models[2].material = request.material;
    const LivePlotResult result = plot_.draw(request, LiveDetail::fine);
    ASSERT_EQ(result.figure.series.size(), 3u);
    const auto mediumBy = [&](const char* inverting) {
        Job job;
        job.scene.material = request.material;
        job.scene.model.id = inverting;
        return subjectOf(job, engine_).medium;
    };
    const Medium shared = mediumBy("better_dipole"), own = mediumBy("dipole");
    EXPECT_GT(std::abs(shared.sigma_a[0] - own.sigma_a[0]), 0.01 * own.sigma_a[0]) << "models do invert differently";
    const std::pair<const char*, const Medium*> expected[] = {
        {"dipole", &shared}, {"better_dipole", &shared}, {"dipole", &own}};
    for (std::size_t i = 0; i < 3; ++i) {
        LoadedModel model = engine_.load(expected[i].first, {}, "auto", *expected[i].second);
        const Series& series = result.figure.series[i];
        const PencilCurve curve = modelCurve(model, 0, series.x, {});
        EXPECT_EQ(series.y[100], curve.Rd[100].r) << i;
    }
}

TEST_F(LivePlotTest, ReferenceComesInTwoStepsAndThenFollowsSlidersWithoutWalks) {
    LiveRequest request = requestOf({"dipole"});
    request.walks = 4e5;
    EXPECT_TRUE(plot_.draw(request, LiveDetail::fine).reference.empty());
    EXPECT_TRUE(plot_.improve(request, observer_));
    EXPECT_EQ(plot_.draw(request, LiveDetail::fine).reference_walks, 1e5);
    EXPECT_TRUE(plot_.improve(request, observer_));
    EXPECT_EQ(plot_.draw(request, LiveDetail::fine).reference_walks, 4e5);
    EXPECT_FALSE(plot_.improve(request, observer_));

    request.material = {.id = "", .sigma_a = {0.01}, .sigma_s = {2}};
    EXPECT_FALSE(plot_.improve(request, observer_)) << "another sigma_a and sigma_s";
    const LivePlotResult result = plot_.draw(request, LiveDetail::fine);
    const Series& reference = seriesCalled(result.figure, "Monte Carlo");
    ReferenceOptions walk;
    walk.walks = 100'000;
    walk.seed = 7;
    walk.edges_mm = reference.x;
    const PencilReference walked = runReference(resolveMaterial(request.material).medium, walk, observer_).curve();
    int far = 0;
    for (std::size_t i = 0; i < reference.y.size(); ++i) {
        // Figures have bands of two standard errors.
        const double ours = 0.25 * (reference.upper[i] - reference.lower[i]), theirs = walked.standard_error[i].r;
        if (std::abs(reference.y[i] - walked.Rd[i].r) > 3 * std::hypot(ours, theirs)) ++far;
    }
    // Of 64 bins 0.2 lie beyond three standard errors; neighbours from one table go together.
    EXPECT_LE(far, 3);
}

TEST_F(LivePlotTest, HalfOfAPairOfTargetsIsAnError) {
    LiveRequest request = requestOf({"dipole"});
    request.material = {.id = "", .Rdr = {0.5}};
    EXPECT_THROW(plot_.draw(request, LiveDetail::fine), Error);
}

TEST_F(LivePlotTest, MediaTooBrightForTablesAreWalked) {
    LiveRequest request = requestOf({"dipole"});
    request.walks = 2000;
    request.material = {.id = "", .sigma_a = {1e-5}, .sigma_s = {2}};
    EXPECT_TRUE(plot_.improve(request, observer_));
    EXPECT_EQ(plot_.draw(request, LiveDetail::fine).reference_walks, 2000);
    EXPECT_FALSE(plot_.improve(request, observer_));
}

TEST_F(LivePlotTest, EveryViewHasItsFigure) {
    LiveRequest request = requestOf({"dipole", "directional_dipole"});
    request.angle_deg = 50;
    for (const auto view :
         {LiveRequest::View::profile, LiveRequest::View::error, LiveRequest::View::plane, LiveRequest::View::slice}) {
        request.view = view;
        while (plot_.improve(request, observer_)) {
        }
        const LivePlotResult result = plot_.draw(request, LiveDetail::coarse);
        EXPECT_TRUE(result.problems.empty());
        EXPECT_THAT(result.reference, HasSubstr("Monte Carlo"));
        if (view == LiveRequest::View::slice)
            EXPECT_EQ(result.figure.panels.size(), 3u);
        else
            EXPECT_GE(result.figure.series.size(), 2u);
    }
    request.view = LiveRequest::View::profile;
    request.solo = 1;
    EXPECT_GE(plot_.draw(request, LiveDetail::coarse).figure.series.size(), 3u) << "three channels";
}

// The budget of the window: 30 ms from slider to curves. The best of several, as other work runs beside it.
TEST_F(LivePlotTest, DrawsWithinThirtyMilliseconds) {
    LiveRequest request = requestOf({"dipole", "better_dipole", "normalized_diffusion", "directional_dipole"});
    request.channel = PlotChannel::luminance;
    while (plot_.improve(request, observer_)) {
    }
    double best = 1e9;
    for (int i = 0; i < 10; ++i) {
        request.material = {.id = "", .sigma_a = {0.01 + 0.01 * i, 0.1, 0.2}, .sigma_s = {2, 1, 0.7}};
        const auto begin = std::chrono::steady_clock::now();
        plot_.draw(request, LiveDetail::fine);
        best =
            std::min(best, std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count());
    }
    RecordProperty("best_ms", std::to_string(best));
    EXPECT_LT(best, 30);
}

}  // namespace
}  // namespace searchlight
