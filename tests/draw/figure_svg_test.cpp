#include <cmath>
#include <limits>

#include "base/error.h"
#include "draw/draw.h"
#include "draw/figure_layout.h"
#include "draw/svg.h"
#include "draw/text_width.h"
#include "well_formed.h"

namespace searchlight {
namespace {

using testing::HasSubstr;
using testing::Not;

const double nan = std::numeric_limits<double>::quiet_NaN();

Figure example() {
    Figure figure;
    figure.title = "R & <D>";
    figure.caption = "Per unit \"incident\" flux.";
    figure.x = {"Radius", "mm"};
    figure.y = {"Reflectance", "1/mm²", AxisScale::logarithmic};
    figure.series.push_back({.label = "dipole", .x = {0, 1, 2, 3}, .y = {1, 0.1, 0.01, 0.001}, .color = 0});
    figure.series.push_back({.label = "reference",
                             .style = SeriesStyle::steps,
                             .x = {0, 1.5, 3},
                             .y = {0.5, 0.005},
                             .lower = {0.4, -0.001},
                             .upper = {0.6, 0.011}});
    figure.metadata = {{"seed", "1 < 2"}};
    return figure;
}

size_t count(std::string_view text, std::string_view part) {
    size_t found = 0;
    for (size_t at = text.find(part); at != std::string_view::npos; at = text.find(part, at + 1)) ++found;
    return found;
}

TEST(EscapeXml, EscapesMarkup) { EXPECT_EQ(escapeXml("a<b> & \"c\""), "a&lt;b&gt; &amp; &quot;c&quot;"); }

TEST(EscapeXml, KeepsUtf8AndReplacesWhatIsNone) {
    EXPECT_EQ(escapeXml("α′ ×10⁻³ 😀"), "α′ ×10⁻³ 😀");
    EXPECT_EQ(escapeXml("a\xFF"
                        "b"),
              "a\uFFFDb");
    EXPECT_EQ(escapeXml("\xC3"), "\uFFFD") << "cut short";
    EXPECT_EQ(escapeXml("\xC0\x80"), "\uFFFD\uFFFD") << "overlong zero";
    EXPECT_EQ(escapeXml("\xED\xA0\x80"), "\uFFFD\uFFFD\uFFFD") << "a surrogate";
    EXPECT_EQ(escapeXml("\x01\x1B\n\t"), "\uFFFD\uFFFD\n\t") << "control characters are not XML";
}

TEST(TextWidth, CountsCharactersNotBytes) {
    EXPECT_DOUBLE_EQ(textWidth("00", 10), 2 * 6.36);
    EXPECT_EQ(textWidth("αα", 10), 2 * textWidth("α", 10));
}

TEST(WrapText, BreaksAtSpacesAndLineEnds) {
    EXPECT_THAT(wrapText("one two three", textWidth("one two", 10), 10), testing::ElementsAre("one two", "three"));
    EXPECT_THAT(wrapText("a\nb", 1000, 10), testing::ElementsAre("a", "b"));
    EXPECT_THAT(wrapText("extraordinary", 1, 10), testing::ElementsAre("extraordinary"));
    EXPECT_THAT(wrapText("", 10, 10), testing::IsEmpty());
}

TEST(FigureSvg, IsWellFormed) {
    EXPECT_EQ(xmlProblem(figureSvg(example())), "");
    EXPECT_NE(xmlProblem("<a><b></a>"), "") << "the check itself can fail";
    EXPECT_NE(xmlProblem("<a>&</a>"), "");
    EXPECT_NE(xmlProblem("<a x=\"<\"/>"), "");
}

TEST(FigureSvg, ShowsTextWithUnitsAndCarriesMetadata) {
    const std::string svg = figureSvg(example());
    for (const char* part : {"R &amp; &lt;D&gt;", "Radius (mm)", "Reflectance (1/mm²)", ">dipole<", ">reference<",
                             "Per unit &quot;incident&quot; flux.", "seed: 1 &lt; 2"})
        EXPECT_THAT(svg, HasSubstr(part));
}

TEST(FigureSvg, SameFigureSameBytes) { EXPECT_EQ(figureSvg(example()), figureSvg(example())); }

TEST(FigureSvg, NeverWritesNanOrInfinity) {
    Figure figure = example();
    figure.series[0].y = {1, nan, INFINITY, -3};
    figure.series[1].upper[1] = INFINITY;
    const std::string svg = figureSvg(figure);
    for (const char before : std::string_view("\" ,"))
        for (const char* word : {"nan", "-nan", "inf", "-inf"})
            EXPECT_THAT(svg, Not(HasSubstr(before + std::string(word))));
}

TEST(FigureSvg, EveryCoordinateLiesOnThePaper) {
    Figure figure = example();
    figure.y.min = 0.005;
    figure.y.max = 0.05;
    figure.x.min = 0.7;
    figure.x.max = 2;
    const Drawing drawing = layoutFigure(figure);
    const Rect paper{0, 0, drawing.width, drawing.height};
    for (const Shape& shape : drawing.shapes) {
        std::vector<Point> points;
        if (const auto* line = std::get_if<Polyline>(&shape)) points = line->points;
        if (const auto* area = std::get_if<Polygon>(&shape)) points = area->points;
        for (const Point& p : points) EXPECT_TRUE(paper.contains(p)) << p.x << ' ' << p.y;
    }
}

TEST(FigureSvg, TheReferenceIsDrawnOverTheModels) {
    Figure figure = example();
    std::swap(figure.series[0], figure.series[1]);
    const std::string svg = figureSvg(figure);
    EXPECT_LT(svg.find("stroke=\"#0072B2\" stroke-width=\"1.9\""), svg.find("stroke=\"#1a1a1a\" stroke-width=\"1.3\""));
}

TEST(FigureSvg, AGapSplitsTheLine) {
    Figure figure;
    figure.series.push_back({.label = "a", .x = {0, 1, 2, 3, 4}, .y = {1, 2, nan, 3, 4}, .color = 0});
    // Two pieces of the curve, one line in the legend.
    EXPECT_EQ(count(figureSvg(figure), "stroke=\"#0072B2\""), 3u);
}

TEST(FigureSvg, HiddenNegativesAreSaidInTheLegend) {
    Figure figure = example();
    EXPECT_THAT(figureSvg(figure), Not(HasSubstr("negative")));
    figure.series[0].y[3] = -0.001;
    EXPECT_THAT(figureSvg(figure), HasSubstr(">dipole (negative part not shown)<"));
    figure.y.scale = AxisScale::square_root;
    EXPECT_THAT(figureSvg(figure), Not(HasSubstr("negative")));
}

TEST(FigureSvg, ASeriesMayStayOutOfTheLegend) {
    Figure figure = example();
    figure.series[0].in_legend = false;
    EXPECT_THAT(figureSvg(figure), Not(HasSubstr(">dipole<")));
}

TEST(FigureSvg, TheLegendStandsBesideWhenDataFillTheFrame) {
    Figure figure;
    for (int k = 0; k < 5; ++k) {
        Series wave{.label = "wave", .color = k};
        for (int i = 0; i <= 200; ++i) {
            wave.x.push_back(i);
            wave.y.push_back(std::sin(0.3 * i + k));
        }
        figure.series.push_back(wave);
    }
    EXPECT_GT(layoutFigure(figure).width, 640);
    figure.series.resize(1);
    figure.series[0].y.assign(201, 1.0);
    EXPECT_EQ(layoutFigure(figure).width, 640);
}

TEST(FigureSvg, BandsReachingZeroLeaveThroughTheBottomOfALogarithmicAxis) {
    // The band of the second bin runs from the frame's bottom (where its lower bound, below zero, would be) upwards.
    const Drawing drawing = layoutFigure(example());
    double frame_bottom = 0, band_bottom = 0;
    for (const Shape& shape : drawing.shapes) {
        if (const auto* box = std::get_if<Box>(&shape); box && box->fill.empty()) frame_bottom = box->rect.bottom;
        if (const auto* area = std::get_if<Polygon>(&shape))
            for (const Point& p : area->points) band_bottom = std::max(band_bottom, p.y);
    }
    EXPECT_EQ(band_bottom, frame_bottom);
}

}  // namespace
}  // namespace searchlight
