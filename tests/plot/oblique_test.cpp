#include "plot/oblique.h"

#include <cmath>

#include "base/error.h"
#include "draw/draw.h"
#include "plot/hemisphere.h"
#include "plot/moments.h"
#include "plot/slice.h"

namespace searchlight {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

Rgb gray(double v) { return {v, v, v}; }

StripPanel panel(std::string heading = "60°") {
    StripPanel strip{.heading = std::move(heading), .edges_mm = {-2, 0, 1, 2}, .half_width_mm = 0.25};
    strip.models.push_back({"dipole", {gray(1), gray(2), gray(1)}});
    strip.models.push_back({"directional", {gray(0.5), gray(4), gray(2)}});
    strip.reference.push_back({"Monte Carlo", {gray(0.4), gray(5), gray(1)}, {gray(0.1), gray(0.2), gray(0.1)}});
    return strip;
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

TEST(ObliqueFigure, ShowsModelsAtTheMiddlesAndTheReferenceAsSteps) {
    const StripPanel strip = panel();
    const Figure figure = obliqueFigure({&strip, 1}, {.title = "Milk"});
    EXPECT_EQ(figure.title, "Milk, 60°");
    ASSERT_EQ(figure.series.size(), 3u);
    EXPECT_THAT(figure.series[1].x, ElementsAre(-1, 0.5, 1.5));
    EXPECT_THAT(figure.series[1].y, ElementsAre(0.5, 4, 2));
    EXPECT_THAT(figure.series[2].x, ElementsAre(-2, 0, 1, 2));
    EXPECT_DOUBLE_EQ(figure.series[2].upper[1], 5 + 2 * 0.2);
    EXPECT_THAT(figure.caption, HasSubstr("|y| < 0.25 mm"));
    EXPECT_FALSE(figureSvg(figure).empty());
}

TEST(ObliqueFigure, PutsAnglesSideBySideUnderOneOrdinate) {
    const std::vector<StripPanel> panels{panel("0°"), panel("30°"), panel("60°")};
    const Figure figure = obliqueFigure(panels, {.title = "Milk"});
    ASSERT_EQ(figure.panels.size(), 3u);
    EXPECT_EQ(figure.columns, 3);
    EXPECT_EQ(figure.panels[0].y.max, figure.panels[2].y.max);
    const std::string csv = figureCsv(figure);
    EXPECT_THAT(csv, HasSubstr("panel,series,x,x_end,y,y_end,value,lower,upper\n"));
    EXPECT_THAT(csv, HasSubstr("30°,directional,0.5,,,,4,,\n"));
    EXPECT_THAT(csv, HasSubstr("60°,Monte Carlo,-2,0,,,0.4,"));
}

TEST(ObliqueFigure, RefusesWhatDoesNotFit) {
    StripPanel strip = panel();
    strip.models[0].means.pop_back();
    EXPECT_EQ(errorOf([&] { obliqueFigure({&strip, 1}, {}); }), "model 'dipole' has 2 means for 3 cells of the strip");
    strip = panel();
    strip.models.clear();
    strip.reference.clear();
    EXPECT_EQ(errorOf([&] { obliqueFigure({&strip, 1}, {}); }), "no model and no reference to plot");
    EXPECT_EQ(errorOf([&] { obliqueFigure({}, {}); }), "no angle to plot");
}

TEST(StripShape, FindsPeakAndMean) {
    const std::vector<Rgb> means{gray(1), gray(3), gray(0)};
    const std::vector<double> edges{-2, 0, 1, 2};
    const StripShape shape = stripShape(means, edges, PlotChannel::red);
    EXPECT_EQ(shape.peak, 3);
    EXPECT_EQ(shape.peak_x_mm, 0.5);
    EXPECT_DOUBLE_EQ(shape.mean_x_mm, (2 * -1 + 3 * 0.5) / 5);
}

// The circle x^2 + y^2 = 1 of cells that hold x^2 + y^2 - 1.
TEST(ZeroContour, IsACircleWhereTheValuesAreThoseOfOne) {
    constexpr std::size_t cells = 40;
    std::vector<double> values;
    const auto middle = [](std::size_t i) { return -2 + 4 * (static_cast<double>(i) + 0.5) / cells; };
    for (std::size_t j = 0; j < cells; ++j)
        for (std::size_t i = 0; i < cells; ++i) values.push_back(std::pow(middle(i), 2) + std::pow(middle(j), 2) - 1);
    const Contour contour = zeroContour(values, cells, 2);
    ASSERT_GT(contour.x.size(), 100u);
    double length = 0;
    for (std::size_t i = 0; i + 2 < contour.x.size(); i += 3) {
        // Linear between points 0.1 apart: the sagitta, h^2 / 8.
        EXPECT_NEAR(std::hypot(contour.x[i], contour.y[i]), 1, 0.0025);
        EXPECT_TRUE(std::isnan(contour.x[i + 2]));
        length += std::hypot(contour.x[i + 1] - contour.x[i], contour.y[i + 1] - contour.y[i]);
    }
    EXPECT_NEAR(length, 2 * M_PI, 0.02);
    for (double& value : values) value = std::abs(value) + 1e-9;
    EXPECT_TRUE(zeroContour(values, cells, 2).x.empty());
}

TEST(SliceFigure, OutlinesWhatIsClampedAndScalesByTheReference) {
    const SlicePanel model{
        "dipole", {gray(9), gray(0), gray(1e-9), gray(1)}, {}, {gray(9), gray(-1), gray(1), gray(1)}};
    const SlicePanel walked{"Monte Carlo", {gray(2), gray(0), gray(1), gray(1)}, std::vector<Rgb>(4, gray(0.1)), {}};
    const std::vector<SlicePanel> panels{model, walked};
    const Figure figure = sliceFigure(panels, {.extent_mm = 5, .decades = 3});
    ASSERT_EQ(figure.panels.size(), 2u);
    EXPECT_EQ(figure.color.max, 2);
    EXPECT_DOUBLE_EQ(figure.color.min, 2e-3);
    EXPECT_EQ(figure.panels[0].series.size(), 1u);
    EXPECT_TRUE(figure.panels[1].series.empty());
    EXPECT_EQ(figure.panels[0].map->scale_bar, 2);
    EXPECT_THAT(figure.caption, HasSubstr("White outline"));
    EXPECT_THAT(figureCsv(figure), HasSubstr("Monte Carlo,map,-5,0,-5,0,2,1.9,2.1\n"));
    EXPECT_THAT(figureSvg(figure), HasSubstr("data:image/png;base64,"));
}

TEST(SliceFigure, RefusesWhatIsNoSquare) {
    const SlicePanel model{"dipole", {gray(9), gray(0), gray(1)}, {}, {}};
    EXPECT_EQ(errorOf([&] { sliceFigure({&model, 1}, {}); }), "'dipole' has 3 cells, which are no square");
    const SlicePanel dark{"dipole", std::vector<Rgb>(4), {}, {}};
    EXPECT_EQ(errorOf([&] { sliceFigure({&dark, 1}, {}); }), "nothing leaves the surface: there is nothing to plot");
}

TEST(MomentsFigure, HasAPanelForEachMoment) {
    const std::vector<double> angles{0, 30};
    const std::vector<MomentCurve> models{{"dipole", {0, 0}, {4, 4}}};
    const MomentReference reference{"Monte Carlo", {{0, 0.1}, {1, 0.1}}, {{5, 0.2}, {6, 0.2}}};
    const Figure figure = momentsFigure(angles, models, &reference, "Milk");
    ASSERT_EQ(figure.panels.size(), 2u);
    EXPECT_EQ(figure.panels[0].y.unit, "mm");
    EXPECT_EQ(figure.panels[1].y.unit, "mm²");
    EXPECT_DOUBLE_EQ(figure.panels[0].series[1].upper[1], 1.2);
    const std::vector<MomentCurve> wrong{{"dipole", {0}, {4}}};
    EXPECT_EQ(errorOf([&] { momentsFigure(angles, wrong, nullptr, ""); }), "'dipole' has 1 moments for 2 angles");
}

TEST(HemisphereFigure, ShowsDiscsAndThePlaneOfIncidence) {
    // Rings of 0 to 45 and 45 to 90 degrees, four azimuths.
    HemispherePanel walked{"Monte Carlo", {}, std::vector<Rgb>(8, gray(0.5))};
    for (int i = 0; i < 8; ++i) walked.radiance.push_back(gray(i));
    const HemispherePanel model{"dipole", std::vector<Rgb>(8, gray(3)), {}};
    const std::vector<HemispherePanel> panels{walked, model};
    const Figure figure = hemisphereFigure(panels, {.polar = 2, .turns = 4});
    ASSERT_EQ(figure.panels.size(), 3u);
    EXPECT_TRUE(figure.panels[0].map->hemisphere);
    const Series& plane = figure.panels[2].series[0];
    EXPECT_THAT(plane.x, ElementsAre(-90, -45, 0, 45, 90));
    // Turns 1 and 2 lie beside the plane on the far side, 3 and 0 on the side of the lean.
    EXPECT_THAT(plane.y, ElementsAre(5.5, 1.5, 1.5, 5.5));
    EXPECT_DOUBLE_EQ(plane.upper[0], 5.5 + 2 * 0.5);
    EXPECT_FALSE(figureSvg(figure).empty());
    EXPECT_EQ(errorOf([&] { hemisphereFigure(panels, {.polar = 2, .turns = 3}); }), "3 cells of azimuth are not even");
}

}  // namespace
}  // namespace searchlight
