#include "draw/legend.h"

#include <algorithm>
#include <cmath>

#include "draw/text_width.h"

namespace searchlight {

namespace {

constexpr double font_size = 12, row_height = 18, swatch_width = 26, padding = 8, gap = 8;
constexpr double inset = 8;      // from the frame
constexpr double clearance = 5;  // between box and data

void drawEntry(std::vector<Shape>& shapes, const LegendEntry& entry, double left, double middle) {
    const double right = left + swatch_width, center = 0.5 * (left + right);
    const SeriesLook& look = entry.look;
    if (entry.style == SeriesStyle::points) {
        if (entry.band) shapes.push_back(Polyline{{{center, middle - 6}, {center, middle + 6}}, {look.color, 1}});
        drawMarker(shapes, {center, middle}, 2.8, look);
    } else {
        const Rect band{left, middle - 5, right, middle + 5};
        if (entry.band) shapes.push_back(Box{band, look.color, {}, look.band_opacity});
        shapes.push_back(Polyline{{{left, middle}, {right, middle}}, {look.color, look.width, look.dashes}});
    }
    shapes.push_back(Text{{right + gap, middle + 4.2}, entry.label, font_size, Anchor::start, "#1a1a1a"});
}

}  // namespace

void drawMarker(std::vector<Shape>& shapes, Point center, double radius, const SeriesLook& look) {
    shapes.emplace_back(Circle{center, radius, look.color});
    if (!look.dashes.empty()) shapes.emplace_back(Circle{center, radius - 1, "#ffffff"});
}

LegendSize legendSize(std::span<const LegendEntry> entries) {
    if (entries.empty()) return {};
    double widest = 0;
    for (const LegendEntry& entry : entries) widest = std::max(widest, textWidth(entry.label, font_size));
    return {2 * padding + swatch_width + gap + widest, padding + row_height * static_cast<double>(entries.size())};
}

LegendPlace placeLegend(const LegendSize& size, const Rect& plot, const DrawnData& data) {
    constexpr int columns = 12, rows = 12;
    const double free_width = plot.width() - 2 * inset - size.width;
    const double free_height = plot.height() - 2 * inset - size.height;
    LegendPlace best;
    double best_cost = INFINITY;
    // From the top right, where most decaying curves leave room.
    for (int row = 0; row <= rows; ++row)
        for (int column = columns; column >= 0; --column) {
            const double left = plot.left + inset + free_width * column / columns;
            const double top = plot.top + inset + free_height * row / rows;
            const Rect box{left, top, left + size.width, top + size.height};
            const Rect kept_clear{box.left - clearance, box.top - clearance, box.right + clearance,
                                  box.bottom + clearance};
            const auto under = [&](Point p) { return kept_clear.contains(p); };
            const auto covered = std::count_if(data.lines.begin(), data.lines.end(), under);
            const auto shaded = std::count_if(data.bands.begin(), data.bands.end(), under);
            const double off_corner = std::min(row, rows - row) + std::min(column, columns - column);
            const double cost = static_cast<double>(covered) + 0.2 * static_cast<double>(shaded) + 0.05 * off_corner;
            if (cost >= best_cost) continue;
            best_cost = cost;
            best = {box, static_cast<int>(covered)};
        }
    return best;
}

void drawLegend(std::vector<Shape>& shapes, std::span<const LegendEntry> entries, const Rect& box) {
    shapes.push_back(Box{box, "#ffffff", "#d9d9d9", 0.88});
    double middle = box.top + 0.5 * padding + 0.5 * row_height;
    for (const LegendEntry& entry : entries) {
        drawEntry(shapes, entry, box.left + padding, middle);
        middle += row_height;
    }
}

double drawLegendRows(std::vector<Shape>& shapes, std::span<const LegendEntry> entries, Point at, double width) {
    const double column = legendSize(entries).width + gap;
    const size_t columns = std::clamp<size_t>(static_cast<size_t>(width / column), 1, entries.size());
    const size_t rows = (entries.size() + columns - 1) / columns;
    for (size_t i = 0; i < entries.size(); ++i)
        drawEntry(shapes, entries[i], at.x + column * static_cast<double>(i / rows),
                  at.y + row_height * (static_cast<double>(i % rows) + 0.5));
    return row_height * static_cast<double>(rows);
}

}  // namespace searchlight
