#include "plot/model_errors.h"

#include <limits>

#include "base/error.h"

namespace searchlight {
namespace {

using testing::ElementsAre;

TEST(ModelErrorsFigure, StandsModelsBesideEachOther) {
    const std::vector<ModelErrors> models{{"a", {{0.1, 0.01}, {0.2}}}, {"b", {{0.3}, {0.4}}}};
    const Figure figure = modelErrorsFigure(models, {"near", "far"}, "Errors");
    EXPECT_THAT(figure.x.names, ElementsAre("near", "far"));
    ASSERT_EQ(figure.series.size(), 2u);
    EXPECT_LT(figure.series[0].x[0], 0);
    EXPECT_GT(figure.series[1].x[0], 0);
    EXPECT_DOUBLE_EQ(figure.series[0].y[0], 10);
    EXPECT_DOUBLE_EQ(figure.series[0].lower[0], 8) << "two standard errors";
    EXPECT_DOUBLE_EQ(figure.series[0].upper[0], 12);
}

TEST(ModelErrorsFigure, LeavesOutWhatIsNotKnown) {
    const std::vector<ModelErrors> models{{"a", {{std::numeric_limits<double>::quiet_NaN()}, {0.2}}}};
    EXPECT_THAT(modelErrorsFigure(models, {"near", "far"}, "Errors").series[0].y, ElementsAre(20));
}

TEST(ModelErrorsFigure, RefusesAModelWithoutAllKinds) {
    const std::vector<ModelErrors> models{{"a", {{0.1}}}};
    try {
        modelErrorsFigure(models, {"near", "far"}, "Errors");
        FAIL();
    } catch (const Error& error) {
        EXPECT_STREQ(error.what(), "model 'a' has 1 errors of 2 kinds");
    }
}

TEST(ModelErrorsFigure, SaysWhatIsBeyondTheFrame) {
    const std::vector<ModelErrors> models{{"a", {{11}, {0.2}}}};
    const Figure figure = modelErrorsFigure(models, {"near", "far"}, "Errors");
    EXPECT_THAT(figure.series[0].y, ElementsAre(20));
    EXPECT_THAT(figure.caption, testing::HasSubstr(" 1 dot above 1000 % not drawn."));
}

TEST(ErrorsOverAlbedoFigure, DrawsADotForEachMedium) {
    const std::vector<ErrorsOverAlbedo> models{{"a", {0.5, 0.99}, {0.1, 0.2}}};
    const Figure figure = errorsOverAlbedoFigure(models, "Errors");
    EXPECT_EQ(figure.series[0].style, SeriesStyle::points);
    EXPECT_DOUBLE_EQ(figure.series[0].x[0], 0.5);
    EXPECT_DOUBLE_EQ(figure.series[0].y[1], 20);
}

}  // namespace
}  // namespace searchlight
