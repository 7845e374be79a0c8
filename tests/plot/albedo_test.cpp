#include "plot/albedo.h"

#include "base/error.h"

namespace searchlight {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

TEST(AlbedoFigure, OneLinePerModelAndPointsWithTwoStandardErrors) {
    const std::vector<AlbedoCurve> models{{"a", {0.1, 0.9}, {0.02, 0.4}}, {"b", {0.1, 0.9}, {0.03, 0.5}}};
    const AlbedoReference reference{"Monte Carlo", {0.5}, {{0.2, 0.01, 100}}};
    const Figure figure = albedoFigure(models, &reference, 1.3);
    ASSERT_EQ(figure.series.size(), 3u);
    EXPECT_THAT(figure.series[1].y, ElementsAre(0.03, 0.5));
    EXPECT_NE(figure.series[0].color, figure.series[1].color);
    const Series& points = figure.series[2];
    EXPECT_EQ(points.style, SeriesStyle::points);
    EXPECT_EQ(points.color, -1);
    EXPECT_DOUBLE_EQ(points.lower[0], 0.18);
    EXPECT_DOUBLE_EQ(points.upper[0], 0.22);
    EXPECT_THAT(figure.caption, HasSubstr("±2 standard errors"));
    EXPECT_EQ(figure.title, "Total diffuse reflectance, relative index 1.3");
}

TEST(AlbedoFigure, ExactReferencesHaveNoBars) {
    const AlbedoReference reference{"exact", {0.5, 0.9}, {{0.1, 0, 0}, {0.4, 0, 0}}};
    const Figure figure = albedoFigure({}, &reference, 1);
    EXPECT_TRUE(figure.series[0].lower.empty());
    EXPECT_THAT(figure.caption, Not(HasSubstr("standard errors")));
}

TEST(AlbedoFigure, ShowsZeroToOneUnlessAModelExceedsEnergy) {
    std::vector<AlbedoCurve> models{{"a", {0.1, 1}, {0.02, 0.4}}};
    EXPECT_EQ(albedoFigure(models, nullptr, 1.5).y.max, 1);
    models[0].total[1] = 1.2;
    EXPECT_GT(albedoFigure(models, nullptr, 1.5).y.max, 1.2);
}

TEST(AlbedoFigure, BadInputIsNamed) {
    const auto error = [](const std::vector<AlbedoCurve>& models) -> std::string {
        try {
            albedoFigure(models, nullptr, 1);
        } catch (const Error& caught) {
            return caught.what();
        }
        return "";
    };
    EXPECT_EQ(error({}), "no model and no reference to plot");
    EXPECT_EQ(error({{"a", {0.1, 0.2}, {0.1}}}), "curve 'a' has 1 totals for 2 albedos");
}

}  // namespace
}  // namespace searchlight
