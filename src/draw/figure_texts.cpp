#include "draw/figure_texts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "draw/plot_area.h"
#include "draw/text_width.h"

namespace searchlight {

namespace {

// What a logarithmic axis drops is said in the legend.
std::string legendLabel(const Figure& figure, const Series& series) {
    const bool hides = figure.y.scale == AxisScale::logarithmic &&
                       std::any_of(series.y.begin(), series.y.end(), [](double y) { return y < 0; });
    return series.label + (hides ? " (negative part not shown)" : "");
}

}  // namespace

std::string axisText(const Axis& axis) {
    return axis.unit.empty() ? axis.label : fmt::format("{} ({})", axis.label, axis.unit);
}

std::vector<LegendEntry> legendEntries(const Figure& figure) {
    std::vector<LegendEntry> entries;
    for (const Series& series : figure.series)
        if (series.in_legend && !series.label.empty())
            entries.push_back({legendLabel(figure, series), series.style, lookOf(series), !series.lower.empty()});
    return entries;
}

void drawFactor(std::vector<Shape>& shapes, Point at, int exponent) {
    constexpr std::string_view base = "×10";
    drawPower(shapes, {at.x + textWidth(base, tick_size), at.y}, base,
              fmt::format("{}{}", exponent < 0 ? "−" : "", std::abs(exponent)));
}

void drawTitle(std::vector<Shape>& shapes, const std::vector<std::string>& lines, double left, double top) {
    double base = top + title_size - 3;
    for (const std::string& line : lines) {
        shapes.push_back(Text{{left, base}, line, title_size, Anchor::start, ink, true});
        base += title_line;
    }
}

void drawCaption(std::vector<Shape>& shapes, const std::vector<std::string>& lines, double top) {
    double base = top - 4;
    for (const std::string& line : lines) {
        base += caption_line;
        shapes.push_back(Text{{page_margin, base}, line, caption_size, Anchor::start, soft_ink});
    }
}

}  // namespace searchlight
