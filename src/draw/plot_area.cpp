#include "draw/plot_area.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "draw/palette.h"
#include "draw/text_width.h"

namespace searchlight {

namespace {

constexpr double major_tick = 5, minor_tick = 3;
constexpr std::string_view frame_color = "#4d4d4d", grid_color = "#e6e6e6";

// Once the colours are used up.
std::vector<double> cycleDashes(size_t cycle) {
    constexpr size_t kinds = 4;
    switch (cycle % kinds) {
        case 1: return {9, 3, 2, 3};
        case 2: return {2, 3};
        case 3: return {12, 3};
        default: return {};
    }
}

// What the legend must stay away from: a point every few px along the line.
void sample(const std::vector<Point>& line, std::vector<Point>& points) {
    constexpr double spacing = 4;
    if (line.empty()) return;
    points.push_back(line.front());
    for (size_t i = 1; i < line.size(); ++i) {
        const Point a = line[i - 1], b = line[i];
        const int count = std::max(1, static_cast<int>(std::hypot(b.x - a.x, b.y - a.y) / spacing));
        for (int k = 1; k <= count; ++k)
            points.push_back({a.x + (b.x - a.x) * k / count, a.y + (b.y - a.y) * k / count});
    }
}

Polyline thinLine(Point from, Point to, std::string_view color) { return {{from, to}, {color, 1}}; }

}  // namespace

SeriesLook lookOf(const Series& series) {
    const std::vector<double> dashed{6, 3};
    if (series.color == outline_color) return {"#ffffff", 1.6, series.dashed ? dashed : std::vector<double>{}, 0.18};
    if (series.color < 0) return {ink, 1.3, series.dashed ? dashed : std::vector<double>{}, 0.18};
    const size_t color = static_cast<size_t>(series.color);
    return {seriesColor(series.color), 1.9,
            series.dashed ? dashed : cycleDashes(color / static_cast<size_t>(series_color_count)), 0.16};
}

double labelWidth(const Tick& tick) {
    return textWidth(tick.label, tick_size) + textWidth(tick.superscript, superscript_size);
}

void drawPower(std::vector<Shape>& shapes, Point joint, std::string_view base, std::string_view exponent) {
    shapes.push_back(Text{joint, std::string(base), tick_size, Anchor::end, ink});
    shapes.push_back(Text{{joint.x + 0.5, joint.y - 5}, std::string(exponent), superscript_size, Anchor::start, ink});
}

PlotArea::PlotArea(const Figure& figure, const Rect& frame, const FigureRange& range, const AxisTicks& x_ticks,
                   const AxisTicks& y_ticks)
    : figure_(figure),
      x_ticks_(x_ticks),
      y_ticks_(y_ticks),
      frame_(frame),
      x_{figure.x.scale, range.x_min, range.x_max, frame.left, frame.right},
      y_{figure.y.scale, range.y_min, range.y_max, frame.bottom, frame.top} {}

void PlotArea::drawGrid(std::vector<Shape>& shapes) const {
    for (const Tick& tick : x_ticks_.ticks) {
        const double x = x_(tick.value);
        if (tick.major) shapes.push_back(thinLine({x, frame_.top}, {x, frame_.bottom}, grid_color));
    }
    for (const Tick& tick : y_ticks_.ticks) {
        const double y = y_(tick.value);
        if (tick.major) shapes.push_back(thinLine({frame_.left, y}, {frame_.right, y}, grid_color));
    }
}

void PlotArea::drawAxes(std::vector<Shape>& shapes) const {
    shapes.push_back(Box{frame_, {}, frame_color});
    const auto label = [&](const Tick& tick, Point at, Anchor anchor) {
        const double exponent = textWidth(tick.superscript, superscript_size);
        const double end = anchor == Anchor::middle ? at.x + 0.5 * labelWidth(tick) : at.x;
        if (!tick.superscript.empty())
            drawPower(shapes, {end - exponent, at.y}, tick.label, tick.superscript);
        else if (!tick.label.empty())
            shapes.push_back(Text{at, tick.label, tick_size, anchor, ink});
    };
    for (const Tick& tick : x_ticks_.ticks) {
        const double x = x_(tick.value), length = tick.major ? major_tick : minor_tick;
        shapes.push_back(thinLine({x, frame_.bottom}, {x, frame_.bottom - length}, frame_color));
        if (figure_.x.names.empty()) {
            label(tick, {x, frame_.bottom + 17}, Anchor::middle);
            continue;
        }
        double base = frame_.bottom + 17;
        for (std::string& line : wrapText(tick.label, x_(1) - x_(0) - 6, tick_size)) {
            shapes.push_back(Text{{x, base}, std::move(line), tick_size, Anchor::middle, ink});
            base += tick_size + 1;
        }
    }
    for (const Tick& tick : y_ticks_.ticks) {
        const double y = y_(tick.value), length = tick.major ? major_tick : minor_tick;
        shapes.push_back(thinLine({frame_.left, y}, {frame_.left + length, y}, frame_color));
        label(tick, {frame_.left - 7, y + 4.2}, Anchor::end);
    }
}

void PlotArea::drawSeries(std::vector<Shape>& shapes, DrawnData& data) const {
    std::vector<const Series*> order;
    for (const Series& series : figure_.series) order.push_back(&series);
    std::stable_partition(order.begin(), order.end(), [](const Series* series) { return series->color >= 0; });
    for (const Series* series : order) {
        if (series->lower.empty()) continue;
        if (series->style == SeriesStyle::points)
            drawErrorBars(shapes, *series);
        else
            drawBand(shapes, *series, data);
    }
    for (const Series* series : order) {
        if (series->style == SeriesStyle::points)
            drawMarkers(shapes, *series, data);
        else
            drawCurve(shapes, *series, data);
    }
}

// Where value i stands; both ends for steps, twice the same otherwise. A histogram's first bin starts at 0, which a
// logarithmic axis shows as its own end.
PlotArea::Extent PlotArea::extent(const Series& series, size_t i) const {
    if (series.style != SeriesStyle::steps) return {x_(series.x[i]), x_(series.x[i])};
    const double right = x_(series.x[i + 1]);
    return {std::isnan(right) ? right : x_.clamped(series.x[i]), right};
}

void PlotArea::drawBand(std::vector<Shape>& shapes, const Series& series, DrawnData& data) const {
    const SeriesLook look = lookOf(series);
    std::vector<Point> up, down;
    const auto close = [&] {
        up.insert(up.end(), down.rbegin(), down.rend());
        std::vector<Point> outline = clipPolygon(up, frame_);
        sample(outline, data.bands);
        if (outline.size() > 2) shapes.push_back(Polygon{std::move(outline), look.color, look.band_opacity});
        up.clear();
        down.clear();
    };
    for (size_t i = 0; i < series.y.size(); ++i) {
        const double high = y_(series.upper[i]), low = y_.clamped(series.lower[i]);
        const auto [left, right] = extent(series, i);
        if (std::isnan(high) || std::isnan(low) || std::isnan(left) || std::isnan(right)) {
            close();
            continue;
        }
        up.push_back({left, high});
        down.push_back({left, low});
        if (series.style != SeriesStyle::steps) continue;
        up.push_back({right, high});
        down.push_back({right, low});
    }
    close();
}

void PlotArea::drawErrorBars(std::vector<Shape>& shapes, const Series& series) const {
    constexpr double cap = 3;
    const std::string_view color = lookOf(series).color;
    for (size_t i = 0; i < series.y.size(); ++i) {
        const double x = x_(series.x[i]), high = y_(series.upper[i]), low = y_.clamped(series.lower[i]);
        const std::array<Point, 2> bar{{{x, high}, {x, low}}};
        for (const std::vector<Point>& piece : clipPolyline(bar, frame_)) {
            shapes.push_back(Polyline{piece, {color, 1}});
            for (const Point& end : bar)
                if (frame_.contains(end)) shapes.push_back(thinLine({x - cap, end.y}, {x + cap, end.y}, color));
        }
    }
}

void PlotArea::drawCurve(std::vector<Shape>& shapes, const Series& series, DrawnData& data) const {
    const SeriesLook look = lookOf(series);
    std::vector<Point> path;
    for (size_t i = 0; i < series.y.size(); ++i) {
        const double y = y_(series.y[i]);
        const auto [left, right] = extent(series, i);
        path.push_back({left, y});
        if (series.style == SeriesStyle::steps) path.push_back({right, y});
    }
    for (std::vector<Point>& piece : clipPolyline(path, frame_)) {
        sample(piece, data.lines);
        // On light and on dark colours.
        if (series.color == outline_color) shapes.push_back(Polyline{piece, {ink, look.width + 1.6}});
        shapes.push_back(Polyline{std::move(piece), {look.color, look.width, look.dashes}});
    }
}

void PlotArea::drawMarkers(std::vector<Shape>& shapes, const Series& series, DrawnData& data) const {
    constexpr double radius = 2.4;
    for (size_t i = 0; i < series.y.size(); ++i) {
        const Point center{x_(series.x[i]), y_(series.y[i])};
        if (!frame_.contains(center)) continue;
        drawMarker(shapes, center, radius, lookOf(series));
        data.lines.push_back(center);
    }
}

}  // namespace searchlight
