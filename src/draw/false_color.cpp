#include "draw/false_color.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.h"
#include "base/text.h"
#include "draw/axis_map.h"
#include "draw/figure_texts.h"
#include "draw/palette.h"
#include "draw/plot_area.h"
#include "draw/text_width.h"
#include "draw/ticks.h"

namespace searchlight {

namespace {

constexpr double bar_width = 14, bar_label_size = 12;
constexpr int bar_ticks = 6;
constexpr double pixels_per_px = 2;
constexpr std::string_view white = "#ffffff";

bool ascending(const std::vector<double>& edges) {
    return edges.size() >= 2 && std::is_sorted(edges.begin(), edges.end(), std::less_equal<>());
}

void check(const FalseColor& map) {
    if (!ascending(map.x_edges) || !ascending(map.y_edges))
        throw inputError("a map needs edges that ascend, at least 2 a side");
    const std::size_t cells = (map.x_edges.size() - 1) * (map.y_edges.size() - 1);
    if (map.values.size() != cells || (!map.standard_error.empty() && map.standard_error.size() != cells))
        throw inputError(fmt::format("a map of {} cells has {} values and {} standard errors", cells, map.values.size(),
                                     map.standard_error.size()));
}

// Cell of a value, or -1.
std::ptrdiff_t cellOf(const std::vector<double>& edges, double value) {
    const auto above = std::upper_bound(edges.begin(), edges.end(), value);
    if (above == edges.begin() || above == edges.end()) return -1;
    return above - edges.begin() - 1;
}

// Pixels of the picture along a side: whole ones for each cell, so that none is wider than another.
int pictureSize(double px, std::size_t cells) {
    const double wanted = pixels_per_px * px, count = static_cast<double>(cells);
    return static_cast<int>(count * std::max(1.0, std::ceil(wanted / count)));
}

Rect discBox(const Rect& frame) {
    const double half = 0.5 * std::min(frame.width(), frame.height());
    const Point center{0.5 * (frame.left + frame.right), 0.5 * (frame.top + frame.bottom)};
    return {center.x - half, center.y - half, center.x + half, center.y + half};
}

}  // namespace

Axis colorAxis(const Axis& asked, const std::vector<const FalseColor*>& maps) {
    for (const FalseColor* map : maps) check(*map);
    Axis axis = asked;
    if (axis.min == axis.max) {
        double low = INFINITY, high = -INFINITY;
        for (const FalseColor* map : maps)
            for (const double value : map->values)
                if (canShow(axis.scale, value)) low = std::min(low, value), high = std::max(high, value);
        if (!(low <= high)) throw inputError("there is no value to give a colour");
        axis.min = low, axis.max = high > low ? high : low + std::max(std::abs(low), 1e-300);
    }
    if (!(axis.min < axis.max) || !canShow(axis.scale, axis.min) || !canShow(axis.scale, axis.max))
        throw inputError(fmt::format("a colour scale from {} to {}", axis.min, axis.max));
    return axis;
}

void drawMap(std::vector<Shape>& shapes, const FalseColor& map, const Axis& color, const Rect& frame) {
    const AxisMap scale{color.scale, color.min, color.max, 0, scale_colors - 1};
    const auto indexOf = [&](double value) {
        // What a logarithmic scale cannot show, 0 and below, has its lowest colour; what is not known has none.
        if (std::isnan(value)) return unknown_color;
        return static_cast<std::uint8_t>(std::lround(std::clamp(scale.clamped(value), 0.0, scale_colors - 1.0)));
    };
    const Rect box = map.hemisphere ? discBox(frame) : frame;
    const std::size_t columns = map.x_edges.size() - 1, rows = map.y_edges.size() - 1;
    const int width = pictureSize(box.width(), map.hemisphere ? 1 : columns);
    const int height = map.hemisphere ? width : pictureSize(box.height(), rows);
    std::vector<std::uint8_t> indices;
    for (int j = 0; j < height; ++j)
        for (int i = 0; i < width; ++i) {
            double x = (i + 0.5) / width, y = 1 - (j + 0.5) / height;
            if (map.hemisphere) {
                const double right = 2 * x - 1, up = 2 * y - 1, turn = std::atan2(up, right) * 180 / std::numbers::pi;
                x = turn < 0 ? turn + 360 : turn;
                y = 90 * std::hypot(right, up);
            } else {
                x = map.x_edges.front() + x * (map.x_edges.back() - map.x_edges.front());
                y = map.y_edges.front() + y * (map.y_edges.back() - map.y_edges.front());
            }
            const std::ptrdiff_t column = cellOf(map.x_edges, x), row = cellOf(map.y_edges, y);
            indices.push_back(
                column < 0 || row < 0
                    ? transparent_color
                    : indexOf(map.values[static_cast<std::size_t>(row) * columns + static_cast<std::size_t>(column)]));
        }
    shapes.push_back(Picture{box, palettePng(width, height, indices)});
    if (!map.hemisphere) return;
    const Point center{0.5 * (box.left + box.right), 0.5 * (box.top + box.bottom)};
    for (const double angle : {30.0, 60.0, 90.0}) {
        std::vector<Point> ring;
        for (int i = 0; i <= 96; ++i) {
            const double turn = 2 * std::numbers::pi * i / 96, radius = 0.5 * box.width() * angle / 90;
            ring.push_back({center.x + radius * std::cos(turn), center.y - radius * std::sin(turn)});
        }
        shapes.push_back(angle < 90 ? Polyline{std::move(ring), {white, 0.7, {2, 3}}}
                                    : Polyline{std::move(ring), {soft_ink, 1}});
    }
}

void drawScaleBar(std::vector<Shape>& shapes, const FalseColor& map, const std::string& unit, const Rect& frame) {
    if (!(map.scale_bar > 0)) return;
    const double length = map.scale_bar * frame.width() / (map.x_edges.back() - map.x_edges.front());
    const double left = frame.left + 9, base = frame.bottom - 9;
    shapes.push_back(Box{{left, base - 3, left + length, base}, white});
    shapes.push_back(Text{{left + 0.5 * length, base - 7},
                          fmt::format("{} {}", prettyNumber(map.scale_bar), unit),
                          tick_size - 1,
                          Anchor::middle,
                          white});
}

double colorBarWidth(const Axis& color) {
    double labels = 0;
    for (const Tick& tick : axisTicks(color.scale, color.min, color.max, bar_ticks).ticks)
        labels = std::max(labels, labelWidth(tick));
    return bar_width + 8 + labels + 8 + bar_label_size;
}

void drawColorBar(std::vector<Shape>& shapes, const Axis& color, const Rect& bar) {
    std::vector<std::uint8_t> indices;
    for (int i = 0; i < scale_colors; ++i) indices.push_back(static_cast<std::uint8_t>(scale_colors - 1 - i));
    const Rect box{bar.left, bar.top, bar.left + bar_width, bar.bottom};
    shapes.push_back(Picture{box, palettePng(1, scale_colors, indices)});
    shapes.push_back(Box{box, {}, soft_ink});
    const AxisMap map{color.scale, color.min, color.max, bar.bottom, bar.top};
    const AxisTicks ticks = axisTicks(color.scale, color.min, color.max, bar_ticks);
    double widest = 0;
    for (const Tick& tick : ticks.ticks) {
        const double y = map(tick.value), length = tick.major ? 5 : 3;
        shapes.push_back(Polyline{{{box.right, y}, {box.right + length, y}}, {soft_ink, 1}});
        const Point at{box.right + 8, y + 4.2};
        if (!tick.superscript.empty())
            drawPower(shapes, {at.x + textWidth(tick.label, tick_size), at.y}, tick.label, tick.superscript);
        else if (!tick.label.empty())
            shapes.push_back(Text{at, tick.label, tick_size, Anchor::start, ink});
        widest = std::max(widest, labelWidth(tick));
    }
    std::string label = color.unit.empty() ? color.label : fmt::format("{} ({})", color.label, color.unit);
    if (ticks.factor != 0) label += fmt::format(" × 1e{}", -ticks.factor);
    shapes.push_back(Text{{box.right + 8 + widest + 8 + bar_label_size - 3, 0.5 * (box.top + box.bottom)},
                          label,
                          bar_label_size,
                          Anchor::middle,
                          ink,
                          false,
                          true});
}

}  // namespace searchlight
