#include <zlib.h>

#include <cmath>
#include <limits>

#include "base/error.h"
#include "draw/draw.h"
#include "draw/false_color.h"
#include "draw/figure_layout.h"
#include "draw/palette.h"
#include "well_formed.h"

namespace searchlight {
namespace {

using testing::HasSubstr;

Figure mapped() {
    Figure figure;
    figure.x = {"x", "mm"};
    figure.y = {"y", "mm"};
    figure.map = FalseColor{.x_edges = {0, 1, 2}, .y_edges = {0, 1}, .values = {1, 10}};
    figure.color = {"Reflectance", "1/mm²", AxisScale::logarithmic};
    return figure;
}

Figure paged() {
    Figure figure;
    figure.title = "Two kinds";
    figure.columns = 2;
    figure.color = mapped().color;
    Figure curve;
    curve.title = "a <curve>";
    curve.x = {"x", "mm"};
    curve.y = {"y", "1"};
    curve.series.push_back({.label = "c", .x = {0, 1}, .y = {1, 2}, .color = 0});
    figure.panels = {mapped(), curve};
    figure.panels[0].title = "a map";
    return figure;
}

// CIE lightness of an sRGB colour.
double lightness(PaletteColor color) {
    const auto linear = [](double c) { return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4); };
    const double y =
        0.2126 * linear(color.r / 255.0) + 0.7152 * linear(color.g / 255.0) + 0.0722 * linear(color.b / 255.0);
    return 116 * std::cbrt(y) - 16;
}

TEST(Palette, GrowsLighterInEvenSteps) {
    const double first = lightness(paletteColor(0)), last = lightness(paletteColor(scale_colors - 1));
    EXPECT_LT(first, 20);
    EXPECT_GT(last, 85);
    for (int i = 25; i < scale_colors; i += 25) {
        const double step = lightness(paletteColor(static_cast<std::uint8_t>(i))) -
                            lightness(paletteColor(static_cast<std::uint8_t>(i - 25)));
        // Viridis is uniform in a better space than CIE's lightness, which sees its steps within a third.
        EXPECT_NEAR(step, 25 * (last - first) / scale_colors, 0.35 * 25 * (last - first) / scale_colors) << i;
    }
}

TEST(Palette, PngHoldsTheIndices) {
    const std::vector<std::uint8_t> indices{0, 100, 200, 253, unknown_color, transparent_color};
    const std::string png = palettePng(3, 2, indices);
    EXPECT_EQ(png.substr(0, 8), "\x89PNG\r\n\x1a\n");
    const std::size_t at = png.find("IDAT") + 4;
    std::string rows(8, '?');
    uLongf size = rows.size();
    ASSERT_EQ(uncompress(reinterpret_cast<Bytef*>(rows.data()), &size, reinterpret_cast<const Bytef*>(png.data() + at),
                         static_cast<uLong>(png.size() - at)),
              Z_OK);
    EXPECT_EQ(rows, std::string({0, 0, 100, static_cast<char>(200), 0, static_cast<char>(253), static_cast<char>(254),
                                 static_cast<char>(255)}));
}

TEST(Panels, BecomeOneWellFormedPage) {
    const std::string svg = figureSvg(paged());
    EXPECT_EQ(xmlProblem(svg), "");
    for (const char* part : {"Two kinds", "a map", "a &lt;curve&gt;", "Reflectance (1/mm²)"})
        EXPECT_THAT(svg, HasSubstr(part));
    EXPECT_EQ(xmlProblem(figureSvg(mapped())), "");
}

TEST(Panels, WithoutAMapHaveNoColourBar) {
    Figure figure = paged();
    figure.panels.erase(figure.panels.begin());
    for (const Shape& shape : layoutFigure(figure).shapes) EXPECT_FALSE(std::holds_alternative<Picture>(shape));
}

TEST(FalseColor, RangeIsThatOfWhatCanBeShown) {
    const FalseColor map{
        .x_edges = {0, 1, 2, 3}, .y_edges = {0, 1}, .values = {0, 2, std::numeric_limits<double>::quiet_NaN()}};
    const FalseColor more{.x_edges = {0, 1}, .y_edges = {0, 1}, .values = {50}};
    const Axis axis = colorAxis({.scale = AxisScale::logarithmic}, {&map, &more});
    EXPECT_EQ(axis.min, 2);
    EXPECT_EQ(axis.max, 50);
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

TEST(FalseColor, RefusesMalformedMaps) {
    Figure figure = mapped();
    figure.map->values.pop_back();
    EXPECT_EQ(errorOf([&] { figureSvg(figure); }), "a map of 2 cells has 1 values and 0 standard errors");
    figure = mapped();
    figure.map->y_edges = {1, 1};
    EXPECT_EQ(errorOf([&] { figureSvg(figure); }), "a map needs edges that ascend, at least 2 a side");
    figure = mapped();
    figure.map->values = {0, -1};
    EXPECT_EQ(errorOf([&] { figureSvg(figure); }), "there is no value to give a colour");
    figure = paged();
    figure.panels[1] = paged();
    EXPECT_EQ(errorOf([&] { figureSvg(figure); }), "a panel of a figure has panels of its own");
}

}  // namespace
}  // namespace searchlight
