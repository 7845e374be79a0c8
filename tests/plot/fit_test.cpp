#include "plot/fit.h"

#include <cmath>

namespace searchlight {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

FitPicture picture() {
    return {.label = "R",
            .color = 3,
            .radii_mm = {0.5, 1.5, 2.5},
            .edges_mm = {0, 1, 2, 3},
            .value = {2, 1, 0.001},
            .standard_error = {0.1, 0.1, 0.01},
            .curve_mm = {0.1, 3},
            .curve = {2, 0.5},
            .relative = {0.1, -0.05, 3}};
}

TEST(FitFigure, ShowsDataAndFitAndWhatIsLeft) {
    const std::vector<FitPicture> channels{picture()};
    const Figure figure = fitFigure(channels, "Dipole, fitted to wax", "Dipole");
    ASSERT_EQ(figure.panels.size(), 2u);
    const Figure &curves = figure.panels[0], &residual = figure.panels[1];
    ASSERT_EQ(curves.series.size(), 2u);
    // The last value is not known to 50 %.
    EXPECT_THAT(curves.series[0].y, ElementsAre(2, 1));
    EXPECT_DOUBLE_EQ(curves.series[0].upper[0], 2.2);
    EXPECT_EQ(curves.series[1].label, "Dipole, R");
    EXPECT_DOUBLE_EQ(residual.series[1].y[0], 10);
    EXPECT_DOUBLE_EQ(residual.series[1].y[1], -5);
    EXPECT_TRUE(std::isnan(residual.series[1].y[2]));
    EXPECT_DOUBLE_EQ(residual.series[0].upper[0], 10);
    EXPECT_EQ(curves.x.max, residual.x.max);
    EXPECT_THAT(figure.caption, HasSubstr("±2 standard errors"));
}

TEST(FitFigure, DataWithoutErrorsHaveNoBand) {
    std::vector<FitPicture> channels{picture()};
    channels[0].standard_error.clear();
    const Figure figure = fitFigure(channels, "Dipole, fitted to wax", "Dipole");
    EXPECT_TRUE(figure.panels[0].series[0].lower.empty());
    EXPECT_TRUE(figure.panels[1].series[0].lower.empty());
    EXPECT_EQ(figure.panels[0].series[0].y.size(), 3u);
}

}  // namespace
}  // namespace searchlight
