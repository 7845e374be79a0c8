#include "draw/figure_layout.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "draw/figure_texts.h"
#include "draw/legend.h"
#include "draw/panel_layout.h"
#include "draw/plot_area.h"
#include "draw/text_width.h"

namespace searchlight {

namespace {

constexpr double document_width = 640, plot_height = 380, factor_line = 16;

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

}  // namespace

Drawing layoutFigure(const Figure& figure) {
    if (figure.map || !figure.panels.empty()) return layoutPanels(figure);
    const FigureRange range = figureRange(figure);
    const auto ticksOf = [](const Axis& axis, double min, double max, int target) {
        return axis.names.empty() ? axisTicks(axis.scale, min, max, target) : namedTicks(axis.names);
    };
    const AxisTicks x_ticks = ticksOf(figure.x, range.x_min, range.x_max, 7);
    const AxisTicks y_ticks = ticksOf(figure.y, range.y_min, range.y_max, 6);

    double tick_labels = 0;
    for (const Tick& tick : y_ticks.ticks) tick_labels = std::max(tick_labels, labelWidth(tick));
    const double right = document_width - page_margin;
    const double left = page_margin + (figure.y.label.empty() ? 0 : label_size + 8) + tick_labels + 7;
    const std::vector<std::string> title = wrapText(figure.title, right - left, title_size, true);
    const double top = std::round(page_margin + title_line * static_cast<double>(title.size()) +
                                  (y_ticks.factor != 0 ? factor_line : 0));
    // Half a px: thin lines then fill a row of pixels instead of two halves.
    const Rect frame{std::round(left) + 0.5, top + 0.5, right + 0.5, top + plot_height + 0.5};

    // The curves first: the legend has to know where they run.
    const PlotArea plot(figure, frame, range, x_ticks, y_ticks);
    std::vector<Shape> curves;
    DrawnData data;
    plot.drawSeries(curves, data);
    const std::vector<LegendEntry> entries = legendEntries(figure);
    const Rect legend = entries.empty() ? Rect{} : legendBox(legendSize(entries), frame, data);

    Drawing drawing;
    drawing.width = std::max(document_width, std::ceil(legend.right + page_margin));
    const double label_base = frame.bottom + (figure.x.label.empty() ? 22 : 40);
    const std::vector<std::string> caption = wrapText(figure.caption, drawing.width - 2 * page_margin, caption_size);
    const double caption_top = std::max(label_base + (caption.empty() ? 0 : 14), legend.bottom);
    drawing.height = std::ceil(caption_top + caption_line * static_cast<double>(caption.size()) + page_margin - 4);

    std::vector<Shape>& shapes = drawing.shapes;
    shapes.push_back(Box{{0, 0, drawing.width, drawing.height}, "#ffffff"});
    drawTitle(shapes, title, frame.left, page_margin);
    plot.drawGrid(shapes);
    shapes.insert(shapes.end(), std::move_iterator(curves.begin()), std::move_iterator(curves.end()));
    plot.drawAxes(shapes);
    if (!entries.empty()) drawLegend(shapes, entries, legend);
    shapes.push_back(
        Text{{0.5 * (frame.left + frame.right), label_base}, axisText(figure.x), label_size, Anchor::middle, ink});
    shapes.push_back(Text{{page_margin + label_size - 3, 0.5 * (frame.top + frame.bottom)},
                          axisText(figure.y),
                          label_size,
                          Anchor::middle,
                          ink,
                          false,
                          true});
    if (y_ticks.factor != 0) drawFactor(shapes, {frame.left, frame.top - 6}, y_ticks.factor);
    if (x_ticks.factor != 0) drawFactor(shapes, {frame.right - 40, label_base}, x_ticks.factor);
    drawCaption(shapes, caption, caption_top);
    return drawing;
}

}  // namespace searchlight
