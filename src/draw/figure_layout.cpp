#include "draw/figure_layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "draw/legend.h"
#include "draw/plot_area.h"
#include "draw/text_width.h"

namespace searchlight {

namespace {

constexpr double document_width = 640, plot_height = 380, panel_height = 130, margin = 16;
constexpr double title_size = 14, label_size = 13, caption_size = 11;
constexpr double title_line = 19, caption_line = 15, factor_line = 16;
constexpr std::string_view soft_ink = "#4d4d4d";

std::string axisText(const Axis& axis) {
    return axis.unit.empty() ? axis.label : fmt::format("{} ({})", axis.label, axis.unit);
}

// What a logarithmic axis drops is said in the legend.
std::string legendLabel(const Figure& figure, const Series& series) {
    const bool hides = figure.y.scale == AxisScale::logarithmic &&
                       std::any_of(series.y.begin(), series.y.end(), [](double y) { return y < 0; });
    return series.label + (hides ? " (negative part not shown)" : "");
}

std::vector<LegendEntry> legendEntries(const Figure& figure) {
    std::vector<LegendEntry> entries;
    for (const Series& series : figure.series)
        if (series.in_legend && !series.label.empty())
            entries.push_back({legendLabel(figure, series), series.style, lookOf(series), !series.lower.empty()});
    return entries;
}

// Within the frame where it hides next to nothing, beside it otherwise.
Rect legendBox(const LegendSize& size, const Rect& frame, const DrawnData& data) {
    constexpr int bearable = 6;  // points of lines under the translucent box
    if (size.width < 0.6 * frame.width() && size.height < 0.6 * frame.height()) {
        const LegendPlace place = placeLegend(size, frame, data);
        if (place.covered <= bearable) return place.box;
    }
    const double left = frame.right + 12;
    return {left, frame.top, left + size.width, frame.top + size.height};
}

// "×10⁻⁵" at the end of an axis whose labels are to be multiplied by it; starts at `at`.
void drawFactor(std::vector<Shape>& shapes, Point at, int exponent) {
    constexpr std::string_view base = "×10";
    drawPower(shapes, {at.x + textWidth(base, tick_size), at.y}, base,
              fmt::format("{}{}", exponent < 0 ? "−" : "", std::abs(exponent)));
}

// Ticks of the ordinate: fewer where there is less room.
AxisTicks ordinateTicks(const Figure& figure, const FigureRange& range, double height) {
    return axisTicks(figure.y.scale, range.y_min, range.y_max, height < plot_height ? 4 : 6);
}

// Where the frame has to begin for the labels on its left.
double frameLeft(const Figure& figure, double height) {
    double tick_labels = 0;
    for (const Tick& tick : ordinateTicks(figure, figureRange(figure), height).ticks)
        tick_labels = std::max(tick_labels, labelWidth(tick));
    return margin + (figure.y.label.empty() ? 0 : label_size + 8) + tick_labels + 7;
}

Drawing layoutPanel(const Figure& figure, double height, double left) {
    const FigureRange range = figureRange(figure);
    const AxisTicks x_ticks = axisTicks(figure.x.scale, range.x_min, range.x_max, 7);
    const AxisTicks y_ticks = ordinateTicks(figure, range, height);
    const double right = document_width - margin;
    const std::vector<std::string> title = wrapText(figure.title, right - left, title_size, true);
    const double top =
        std::round(margin + title_line * static_cast<double>(title.size()) + (y_ticks.factor != 0 ? factor_line : 0));
    // Half a px: thin lines then fill a row of pixels instead of two halves.
    const Rect frame{std::round(left) + 0.5, top + 0.5, right + 0.5, top + height + 0.5};

    // The curves first: the legend has to know where they run.
    const PlotArea plot(figure, frame, range, x_ticks, y_ticks);
    std::vector<Shape> curves;
    DrawnData data;
    plot.drawSeries(curves, data);
    const std::vector<LegendEntry> entries = legendEntries(figure);
    const Rect legend = entries.empty() ? Rect{} : legendBox(legendSize(entries), frame, data);

    Drawing drawing;
    drawing.width = std::max(document_width, std::ceil(legend.right + margin));
    const double label_base = frame.bottom + (figure.x.label.empty() ? 22 : 40);
    const std::vector<std::string> caption = wrapText(figure.caption, drawing.width - 2 * margin, caption_size);
    const double caption_top = std::max(label_base + (caption.empty() ? 0 : 14), legend.bottom);
    drawing.height = std::ceil(caption_top + caption_line * static_cast<double>(caption.size()) + margin - 4);

    std::vector<Shape>& shapes = drawing.shapes;
    shapes.push_back(Box{{0, 0, drawing.width, drawing.height}, "#ffffff"});
    double base = margin + title_size - 3;
    for (const std::string& line : title) {
        shapes.push_back(Text{{frame.left, base}, line, title_size, Anchor::start, ink, true});
        base += title_line;
    }
    plot.drawGrid(shapes);
    shapes.insert(shapes.end(), std::move_iterator(curves.begin()), std::move_iterator(curves.end()));
    plot.drawAxes(shapes);
    if (!entries.empty()) drawLegend(shapes, entries, legend);
    shapes.push_back(
        Text{{0.5 * (frame.left + frame.right), label_base}, axisText(figure.x), label_size, Anchor::middle, ink});
    shapes.push_back(Text{{margin + label_size - 3, 0.5 * (frame.top + frame.bottom)},
                          axisText(figure.y),
                          label_size,
                          Anchor::middle,
                          ink,
                          false,
                          true});
    if (y_ticks.factor != 0) drawFactor(shapes, {frame.left, frame.top - 6}, y_ticks.factor);
    if (x_ticks.factor != 0) drawFactor(shapes, {frame.right - 40, label_base}, x_ticks.factor);
    base = caption_top - 4;
    for (const std::string& line : caption) {
        base += caption_line;
        shapes.push_back(Text{{margin, base}, line, caption_size, Anchor::start, soft_ink});
    }
    return drawing;
}

struct MoveDown {
    double by;
    void operator()(Polyline& line) const {
        for (Point& point : line.points) point.y += by;
    }
    void operator()(Polygon& polygon) const {
        for (Point& point : polygon.points) point.y += by;
    }
    void operator()(Box& box) const { box.rect.top += by, box.rect.bottom += by; }
    void operator()(Circle& circle) const { circle.center.y += by; }
    void operator()(Text& text) const { text.at.y += by; }
    void operator()(Picture& picture) const { picture.rect.top += by, picture.rect.bottom += by; }
};

}  // namespace

Drawing layoutFigure(const Figure& figure) {
    double left = frameLeft(figure, plot_height);
    for (const Figure& panel : figure.below) left = std::max(left, frameLeft(panel, panel_height));
    Drawing drawing = layoutPanel(figure, plot_height, left);
    for (const Figure& panel : figure.below) {
        Drawing lower = layoutPanel(panel, panel_height, left);
        for (Shape& shape : lower.shapes) std::visit(MoveDown{drawing.height}, shape);
        drawing.shapes.insert(drawing.shapes.end(), std::move_iterator(lower.shapes.begin()),
                              std::move_iterator(lower.shapes.end()));
        drawing.width = std::max(drawing.width, lower.width);
        drawing.height += lower.height;
    }
    return drawing;
}

}  // namespace searchlight
