#include "plot/pencil.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "draw/draw.h"

namespace searchlight {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

PencilCurve model(std::string label = "dipole") {
    return {std::move(label),
            {0.5, 1, 2, 3},
            {{0.8, 0.4, 0.2}, {0.4, 0.2, 0.1}, {0.2, 0.1, 0.05}, {0.1, 0.05, 0.025}},
            {{0.9, 0.4, 0.2}, {0.11, 0.1, 0.05}}};
}

PencilReference reference() {
    return {"Monte Carlo", {0, 1, 3}, {{1, 0.5, 0.25}, {0.1, 0.1, 0.1}}, {{0.01, 0.02, 0.03}, {0.01, 0.01, 0.01}}};
}

const Series& seriesOf(const Figure& figure, std::string_view label) {
    const auto found = std::find_if(figure.series.begin(), figure.series.end(),
                                    [&](const Series& series) { return series.label == label; });
    if (found == figure.series.end()) throw std::runtime_error("no series " + std::string(label));
    return *found;
}

template <class Call>
std::string errorOf(Call call) {
    try {
        call();
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

TEST(PencilFigure, ShowsTheChannelAskedFor) {
    const std::vector<PencilCurve> models{model()};
    EXPECT_THAT(seriesOf(pencilFigure(models, nullptr, {}), "dipole").y, ElementsAre(0.8, 0.4, 0.2, 0.1));
    EXPECT_THAT(seriesOf(pencilFigure(models, nullptr, {.channel = PlotChannel::blue}), "dipole").y,
                ElementsAre(0.2, 0.1, 0.05, 0.025));
}

TEST(PencilFigure, LuminanceWeighsMeansAndErrorsOfIndependentChannels) {
    const PencilReference tally = reference();
    const Figure figure = pencilFigure({}, &tally, {.channel = PlotChannel::luminance, .band_sigmas = 3});
    const Series& series = seriesOf(figure, "Monte Carlo");
    const double mean = 0.2126 * 1 + 0.7152 * 0.5 + 0.0722 * 0.25;
    const double error =
        std::sqrt(std::pow(0.2126 * 0.01, 2) + std::pow(0.7152 * 0.02, 2) + std::pow(0.0722 * 0.03, 2));
    EXPECT_DOUBLE_EQ(series.y[0], mean);
    EXPECT_DOUBLE_EQ(series.upper[0], mean + 3 * error);
    EXPECT_DOUBLE_EQ(series.lower[0], mean - 3 * error);
}

TEST(PencilFigure, RadiusPowerMultipliesCurvesBinsAndBands) {
    const std::vector<PencilCurve> models{model()};
    const PencilReference tally = reference();
    const Figure once = pencilFigure(models, &tally, {.radius_power = 1});
    EXPECT_THAT(seriesOf(once, "dipole").y, ElementsAre(0.8 * 0.5, 0.4 * 1, 0.2 * 2, 0.1 * 3));
    EXPECT_EQ(once.y.unit, "1/mm");
    const Figure twice = pencilFigure(models, &tally, {.radius_power = 2});
    const Series& bins = seriesOf(twice, "Monte Carlo");
    // Middle radii 0.5 and 2.
    EXPECT_THAT(bins.y, ElementsAre(1 * 0.25, 0.1 * 4));
    EXPECT_DOUBLE_EQ(bins.upper[1], (0.1 + 2 * 0.01) * 4);
    EXPECT_EQ(twice.y.unit, "");
    EXPECT_THAT(twice.caption, HasSubstr("times its middle radius"));
}

TEST(PencilFigure, RadiusIsADistanceOnTheNearSideToo) {
    PencilCurve oblique{"dipole", {-2, -1, 1}, {{0.1, 0, 0}, {0.3, 0, 0}, {0.5, 0, 0}}, {}};
    const Figure figure = pencilFigure({&oblique, 1}, nullptr, {.radius_power = 1, .angle_deg = 45});
    EXPECT_THAT(figure.series[0].y, ElementsAre(0.2, 0.3, 0.5));
    EXPECT_THAT(figure.title, HasSubstr("incident at 45°"));
}

TEST(PencilFigure, MarksBinMeansOnlyWhereTheCurveCannotStandForThem) {
    const std::vector<PencilCurve> models{model()};
    const PencilReference tally = reference();
    const Figure figure = pencilFigure(models, &tally, {});
    // At 0.5 the curve is 0.8, the mean 0.9; at 2 they are 0.2 and 0.11.
    const Series& means = seriesOf(figure, "dipole, mean over the annulus");
    EXPECT_THAT(means.x, ElementsAre(0.5, 2));
    EXPECT_THAT(means.y, ElementsAre(0.9, 0.11));
    EXPECT_EQ(means.color, seriesOf(figure, "dipole").color);
    EXPECT_FALSE(means.in_legend);
    EXPECT_THAT(figure.caption, HasSubstr("dots"));

    std::vector<PencilCurve> close{model()};
    close[0].bin_means = {{0.81, 0, 0}, {0.199, 0, 0}};
    const Figure plain = pencilFigure(close, &tally, {});
    EXPECT_EQ(plain.series.size(), 2u);
    EXPECT_THAT(plain.caption, Not(HasSubstr("dots")));
}

TEST(PencilFigure, CaptionStatesTheConvention) {
    const PencilReference tally = reference();
    const Figure figure = pencilFigure({}, &tally, {.material = "skin1"});
    EXPECT_EQ(figure.title, "Searchlight profile for skin1, red, normal incidence");
    EXPECT_EQ(figure.caption,
              "Per unit incident flux: Fresnel transmission of the beam included, specular reflection apart. "
              "Reference: mean over each annulus; band: ±2 standard errors.");
}

TEST(PencilFigure, SoloShowsTheChannelsOfOneModel) {
    const std::vector<PencilCurve> models{model("dipole"), model("better")};
    const Figure figure = pencilFigure(models, nullptr, {.solo = "better"});
    ASSERT_EQ(figure.series.size(), 3u);
    EXPECT_EQ(figure.series[0].label, "better, red");
    EXPECT_EQ(figure.series[1].label, "better, green");
    EXPECT_EQ(figure.series[2].label, "better, blue");
    EXPECT_THAT(figure.series[1].y, ElementsAre(0.4, 0.2, 0.1, 0.05));
}

TEST(PencilFigure, SoloOfAGrayModelIsOneCurveInItsOwnColour) {
    std::vector<PencilCurve> models{model("dipole"), model("gray")};
    for (Rgb& value : models[1].Rd) value.g = value.b = value.r;
    const Figure figure = pencilFigure(models, nullptr, {.solo = "gray"});
    ASSERT_EQ(figure.series.size(), 1u);
    EXPECT_EQ(figure.series[0].color, 1);
}

TEST(PencilFigure, LogarithmicOrdinateShowsTheKnownDecades) {
    // Falls by 10 per bin to 1e-9; known to 50 % down to 1e-4.
    PencilReference tally{"Monte Carlo", {0}, {}, {}};
    PencilCurve curve{"steep", {}, {}, {}};
    for (int i = 0; i < 10; ++i) {
        const double value = std::pow(10.0, -i), error = i <= 4 ? 0.1 * value : 0.9 * value;
        tally.edges_mm.push_back(i + 1);
        tally.Rd.push_back({value, value, value});
        tally.standard_error.push_back({error, error, error});
        curve.x_mm.push_back(i + 0.5);
        curve.Rd.push_back({1000 * value, 0, 0});
    }
    const Figure beside = pencilFigure({&curve, 1}, &tally, {});
    EXPECT_LT(beside.y.min, 1e-4);
    EXPECT_GT(beside.y.min, 1e-5);
    EXPECT_LT(beside.y.max, 20) << "a model far above the reference does not set the scale";
    const Figure alone = pencilFigure({&curve, 1}, nullptr, {});
    EXPECT_GT(alone.y.max, 1000);
    EXPECT_NEAR(alone.y.max / alone.y.min, 2.25e6, 1) << "six decades and a margin of 1.5 at either end";
}

TEST(PencilFigure, LogarithmicAbscissaKeepsPartOfTheFirstBin) {
    const PencilReference tally = reference();
    const Figure figure = pencilFigure({}, &tally, {.x_scale = AxisScale::logarithmic});
    EXPECT_EQ(figure.x.min, 0.5);
    EXPECT_EQ(figure.x.max, 3);
    EXPECT_FALSE(figureSvg(figure).empty());
}

TEST(PencilFigure, BadInputIsNamed) {
    const std::vector<PencilCurve> models{model("dipole"), model("better_dipole")};
    PencilReference tally = reference();
    EXPECT_EQ(errorOf([&] { pencilFigure({}, nullptr, {}); }), "no model and no reference to plot");
    EXPECT_EQ(errorOf([&] { pencilFigure(models, nullptr, {.radius_power = 3}); }), "radius power 3 is not 0, 1 or 2");
    EXPECT_EQ(errorOf([&] { pencilFigure(models, nullptr, {.band_sigmas = 0}); }),
              "a band of 0 standard errors is not positive");
    EXPECT_THAT(
        errorOf([&] { pencilFigure(models, nullptr, {.solo = "beter_dipole"}); }),
        testing::AllOf(testing::StartsWith("unknown model to solo 'beter_dipole'"), HasSubstr("better_dipole")));
    std::vector<PencilCurve> ragged{model()};
    ragged[0].bin_means.pop_back();
    EXPECT_EQ(errorOf([&] { pencilFigure(ragged, &tally, {}); }),
              "model 'dipole' has 1 bin means for 2 annuli of the reference");
    ragged[0].Rd.pop_back();
    EXPECT_EQ(errorOf([&] { pencilFigure(ragged, nullptr, {}); }), "model 'dipole' has 3 values at 4 radii");
    tally.edges_mm.pop_back();
    EXPECT_EQ(errorOf([&] { pencilFigure({}, &tally, {}); }),
              "reference 'Monte Carlo' has 2 edges and 2 standard errors for 2 values (n values need n + 1 edges and n "
              "standard errors)");
}

TEST(RelativeErrorFigure, ComparesBinMeansWithTheReference) {
    const std::vector<PencilCurve> models{model()};
    const Figure figure = relativeErrorFigure(models, reference(), {});
    const Series& error = seriesOf(figure, "dipole");
    ASSERT_EQ(error.y.size(), 2u);
    // (0.9 - 1) / 1 and (0.11 - 0.1) / 0.1, in per cent; two roundings of numbers near 1.
    EXPECT_NEAR(error.y[0], -10, 1e-12);
    EXPECT_NEAR(error.y[1], 10, 1e-12);
    const Series& zero = seriesOf(figure, "Monte Carlo");
    EXPECT_THAT(zero.y, ElementsAre(0, 0));
    EXPECT_NEAR(zero.upper[1], 20, 1e-12);  // two standard errors of a tenth
    EXPECT_EQ(figure.y.max, 20);            // holds 1.1 times the errors of 10 %
    EXPECT_EQ(figure.y.min, -20);
    EXPECT_EQ(figure.y.unit, "%");
}

TEST(RelativeErrorFigure, LeavesOutWhatTheReferenceDoesNotKnowAndSaysSo) {
    const std::vector<PencilCurve> models{model()};
    PencilReference tally = reference();
    tally.standard_error[1].r = 0.051;
    const Figure figure = relativeErrorFigure(models, tally, {});
    EXPECT_TRUE(std::isnan(seriesOf(figure, "dipole").y[1]));
    EXPECT_TRUE(std::isnan(seriesOf(figure, "Monte Carlo").y[1]));
    EXPECT_THAT(figure.caption,
                HasSubstr("1 of 2 annuli are left out: the reference's own standard error exceeds 50 %"));
    tally.Rd[0].r = 0;
    EXPECT_EQ(errorOf([&] { relativeErrorFigure(models, tally, {}); }),
              "no bin of reference 'Monte Carlo' is known to 50 % (walk more, or use wider bins)");
}

TEST(RelativeErrorFigure, TheViewIsAtMostAHundredPercentAndCountsTheRest) {
    std::vector<PencilCurve> models{model()};
    models[0].bin_means = {{5, 0, 0}, {0.3, 0, 0}};
    const Figure figure = relativeErrorFigure(models, reference(), {});
    EXPECT_EQ(figure.y.max, 100);
    EXPECT_THAT(figure.caption, HasSubstr("2 of 2 values lie beyond the frame"));
}

TEST(RelativeErrorFigure, NeedsBinMeans) {
    std::vector<PencilCurve> models{model()};
    models[0].bin_means.clear();
    EXPECT_EQ(errorOf([&] { relativeErrorFigure(models, reference(), {}); }),
              "no model has means over the reference's annuli to compare");
}

}  // namespace
}  // namespace searchlight
