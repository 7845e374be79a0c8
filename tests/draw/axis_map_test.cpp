#include "draw/axis_map.h"

#include <cmath>
#include <limits>

#include "base/error.h"

namespace searchlight {
namespace {

const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();

Figure figureOf(std::vector<double> x, std::vector<double> y, AxisScale y_scale = AxisScale::linear) {
    Figure figure;
    figure.y.scale = y_scale;
    figure.series.push_back({.label = "a", .x = std::move(x), .y = std::move(y)});
    return figure;
}

std::string errorOf(const Figure& figure) {
    try {
        figureRange(figure);
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

TEST(AxisMap, PlacesValuesByTheirScale) {
    EXPECT_DOUBLE_EQ((AxisMap{AxisScale::linear, 0, 10, 100, 200})(2.5), 125);
    EXPECT_DOUBLE_EQ((AxisMap{AxisScale::logarithmic, 1, 100, 100, 200})(10), 150);
    EXPECT_DOUBLE_EQ((AxisMap{AxisScale::square_root, 0, 100, 100, 200})(25), 150);
    EXPECT_DOUBLE_EQ((AxisMap{AxisScale::square_root, -4, 4, 100, 200})(-1), 125) << "the sign is kept";
    EXPECT_DOUBLE_EQ((AxisMap{AxisScale::linear, 0, 10, 200, 100})(2.5), 175) << "upwards on paper";
}

TEST(AxisMap, WhatCannotBeShownIsNan) {
    const AxisMap map{AxisScale::logarithmic, 1, 100, 0, 1};
    for (const double value : {0.0, -1.0, nan, inf, -inf}) EXPECT_TRUE(std::isnan(map(value))) << value;
    EXPECT_EQ(map.clamped(0), 0) << "a bin that starts at 0 starts at the axis' end";
    EXPECT_TRUE(std::isnan((AxisMap{})(nan)));
}

TEST(FigureRange, ConstantsAndSinglePointsGetARange) {
    for (const AxisScale scale : {AxisScale::linear, AxisScale::logarithmic, AxisScale::square_root}) {
        const FigureRange range = figureRange(figureOf({3}, {5}, scale));
        EXPECT_LT(range.x_min, 3);
        EXPECT_GT(range.x_max, 3);
        EXPECT_LT(range.y_min, 5);
        EXPECT_GT(range.y_max, 5);
    }
    const FigureRange zero = figureRange(figureOf({0, 1}, {0, 0}));
    EXPECT_LT(zero.y_min, 0);
    EXPECT_GT(zero.y_max, 0);
}

TEST(FigureRange, SkipsNanAndInfinity) {
    const FigureRange range = figureRange(figureOf({0, 1, 2, 3, nan}, {1, nan, inf, 2, 100}));
    EXPECT_EQ(range.x_max, 3);
    EXPECT_LT(range.y_max, 2.5);
}

TEST(FigureRange, LogarithmicAxisLooksAtPositiveValuesOnly) {
    const FigureRange range = figureRange(figureOf({0, 1, 2}, {-5, 1, 100}, AxisScale::logarithmic));
    EXPECT_GT(range.y_min, 0.5);
    EXPECT_EQ(range.x_min, 1);
}

TEST(FigureRange, GivenRangesStay) {
    Figure figure = figureOf({0, 1}, {1, 2});
    figure.y.min = -40;
    figure.y.max = 40;
    EXPECT_EQ(figureRange(figure).y_min, -40);
    EXPECT_EQ(figureRange(figure).y_max, 40);
}

TEST(FigureRange, HugeRangesStayFinite) {
    const FigureRange range = figureRange(figureOf({-1e299, 1e299}, {1e-299, 1e299}, AxisScale::logarithmic));
    EXPECT_TRUE(std::isfinite(range.x_max - range.x_min));
    EXPECT_GT(range.y_min, 0);
}

TEST(FigureRange, NothingToShowIsAnError) {
    const std::string nothing =
        "the figure has nothing to show: no series has a finite point within its axes (a logarithmic axis shows "
        "positive values only)";
    EXPECT_EQ(errorOf({}), nothing);
    EXPECT_EQ(errorOf(figureOf({}, {})), nothing);
    EXPECT_EQ(errorOf(figureOf({1, 2}, {nan, inf})), nothing);
    EXPECT_EQ(errorOf(figureOf({1, 2}, {0, -1}, AxisScale::logarithmic)), nothing);
}

TEST(FigureRange, MalformedSeriesAreErrors) {
    EXPECT_EQ(errorOf(figureOf({1, 2, 3}, {1, 2})), "series 'a' has 3 x for 2 y, expected 2");
    Figure steps = figureOf({1, 2}, {1, 2});
    steps.series[0].style = SeriesStyle::steps;
    EXPECT_EQ(errorOf(steps), "series 'a' has 2 x for 2 y, expected 3 (steps have one more edge than values)");
    Figure band = figureOf({1, 2}, {1, 2});
    band.series[0].lower = {0};
    EXPECT_EQ(errorOf(band), "series 'a' has a band of 1 lower and 0 upper bounds for 2 y");
}

TEST(FigureRange, ImpossibleAxesAreErrors) {
    Figure figure = figureOf({1, 2}, {1, 2}, AxisScale::logarithmic);
    figure.y.max = 10;
    EXPECT_EQ(errorOf(figure), "the y axis cannot run from 0 to 10 (a logarithmic axis needs 0 < min < max)");
    figure.y = {};
    figure.x.min = 2;
    figure.x.max = 1;
    EXPECT_EQ(errorOf(figure), "the x axis cannot run from 2 to 1 (an axis needs min < max, both finite)");
    figure.x.min = nan;
    EXPECT_EQ(errorOf(figure), "the x axis cannot run from nan to 1 (an axis needs min < max, both finite)");
}

}  // namespace
}  // namespace searchlight
