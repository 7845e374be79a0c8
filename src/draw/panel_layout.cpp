#include "draw/panel_layout.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "base/error.h"
#include "draw/false_color.h"
#include "draw/figure_texts.h"
#include "draw/plot_area.h"
#include "draw/text_width.h"

namespace searchlight {

namespace {

constexpr double gap = 30, heading_line = 18, heading_size = 12, tick_line = 20, label_line = 18;
constexpr double bar_gap = 16, longest_bar = 260;

// A hemisphere has no axes.
bool hasAxes(const Figure& panel) { return !panel.map || !panel.map->hemisphere; }

FigureRange rangeOf(const Figure& panel) {
    if (!panel.map) return figureRange(panel);
    const FalseColor& map = *panel.map;
    return {map.x_edges.front(), map.x_edges.back(), map.y_edges.front(), map.y_edges.back()};
}

AxisTicks unlabelled(AxisTicks ticks) {
    for (Tick& tick : ticks.ticks) tick.label.clear(), tick.superscript.clear();
    return ticks;
}

class Page {
public:
    explicit Page(const Figure& figure) : figure_(figure) {
        if (figure.panels.empty()) {
            panels_.push_back(&figure);
        } else {
            for (const Figure& panel : figure.panels) {
                if (!panel.panels.empty()) throw inputError("a panel of a figure has panels of its own");
                panels_.push_back(&panel);
            }
        }
        columns_ = std::clamp<std::size_t>(static_cast<std::size_t>(std::max(figure.columns, 1)), 1, panels_.size());
        rows_ = (panels_.size() + columns_ - 1) / columns_;
        std::vector<const FalseColor*> maps;
        for (const Figure* panel : panels_)
            if (panel->map) maps.push_back(&*panel->map);
        has_bar_ = !maps.empty();
        if (has_bar_) color_ = colorAxis(figure.color, maps);
        for (const Figure* panel : panels_) {
            ranges_.push_back(rangeOf(*panel));
            const int target = columns_ > 2 ? 5 : 7;
            x_ticks_.push_back(ticksOf(panel->x, ranges_.back().x_min, ranges_.back().x_max, target));
            y_ticks_.push_back(ticksOf(panel->y, ranges_.back().y_min, ranges_.back().y_max, 6));
        }
        for (std::size_t i = 0; i < panels_.size(); ++i) {
            if (!showsX(i)) x_ticks_[i] = unlabelled(x_ticks_[i]);
            if (!showsY(i)) y_ticks_[i] = unlabelled(y_ticks_[i]);
        }
    }

    Drawing draw(double width, bool maps) {
        draws_maps_ = maps;
        Drawing drawing;
        drawing.width = width > 0 ? width : columns_ == 1 ? 640 : columns_ == 2 ? 820 : columns_ == 3 ? 960 : 1080;
        const double bar = has_bar_ ? bar_gap + colorBarWidth(color_) : 0;
        std::vector<double> gutters;
        double taken = 2 * page_margin + bar;
        for (std::size_t column = 0; column < columns_; ++column) {
            gutters.push_back(gutter(column));
            taken += gutters.back();
        }
        const double side = std::floor((drawing.width - taken) / static_cast<double>(columns_));
        const double text_width = drawing.width - 2 * page_margin;
        const std::vector<std::string> title = wrapText(figure_.title, text_width, title_size, true);
        std::vector<Shape>& shapes = drawing.shapes;
        shapes.push_back(Box{});  // the paper, when its height is known
        drawTitle(shapes, title, page_margin, page_margin);
        double y = page_margin + title_line * static_cast<double>(title.size()) + 2;

        Rect first{};
        for (std::size_t row = 0; row < rows_; ++row) {
            const auto [height, above, below] = rowHeights(row, side);
            double x = page_margin;
            for (std::size_t column = 0; column < columns_ && row * columns_ + column < panels_.size(); ++column) {
                const std::size_t i = row * columns_ + column;
                x += gutters[column];
                const Rect frame{std::round(x) + 0.5, std::round(y + above) + 0.5, std::round(x) + side + 0.5,
                                 std::round(y + above + height) + 0.5};
                if (i == 0) first = frame;
                const FigureRange& range = ranges_[i];
                if (hasAxes(*panels_[i]))
                    drawing.frames.push_back({frame, range.x_min, range.x_max, range.y_min, range.y_max});
                drawPanel(shapes, i, frame);
                x += side;
            }
            y += above + height + below;
        }
        if (has_bar_) {
            const double left = drawing.width - page_margin - bar + bar_gap;
            drawColorBar(
                shapes, color_,
                {left, first.top, left, std::min(y - tick_line, first.top + std::max(first.height(), longest_bar))});
        }
        const std::vector<LegendEntry> entries = legend();
        if (!entries.empty()) y += 4 + drawLegendRows(shapes, entries, {page_margin, y}, text_width);
        const std::vector<std::string> caption = wrapText(figure_.caption, text_width, caption_size);
        drawCaption(shapes, caption, y + 4);
        drawing.height = std::ceil(y + 4 + caption_line * static_cast<double>(caption.size()) + page_margin - 4);
        shapes.front() = Box{{0, 0, drawing.width, drawing.height}, "#ffffff"};
        return drawing;
    }

private:
    struct RowHeights {
        double frame, above, below;
    };

    // The panel to the left, or below, has the same axis, and speaks for this one.
    bool showsY(std::size_t i) const {
        if (!hasAxes(*panels_[i])) return false;
        if (i % columns_ == 0 || !hasAxes(*panels_[i - 1])) return true;
        const FigureRange &a = ranges_[i], &b = ranges_[i - 1];
        const Axis &mine = panels_[i]->y, &other = panels_[i - 1]->y;
        return a.y_min != b.y_min || a.y_max != b.y_max || mine.scale != other.scale || mine.label != other.label;
    }
    bool showsX(std::size_t i) const {
        if (!hasAxes(*panels_[i])) return false;
        const std::size_t under = i + columns_;
        if (under >= panels_.size() || !hasAxes(*panels_[under])) return true;
        const FigureRange &a = ranges_[i], &b = ranges_[under];
        const Axis &mine = panels_[i]->x, &other = panels_[under]->x;
        return a.x_min != b.x_min || a.x_max != b.x_max || mine.scale != other.scale || mine.label != other.label;
    }
    // A label is written once per run of panels that share it, though their ranges differ.
    bool labelsY(std::size_t i) const {
        return showsY(i) && !panels_[i]->y.label.empty() &&
               (i % columns_ == 0 || panels_[i]->y.label != panels_[i - 1]->y.label);
    }

    double gutter(std::size_t column) const {
        double widest = 0;
        for (std::size_t i = column; i < panels_.size(); i += columns_) {
            double width = labelsY(i) ? label_size + 8 : 0;
            double labels = 0;
            if (showsY(i))
                for (const Tick& tick : y_ticks_[i].ticks) labels = std::max(labels, labelWidth(tick));
            widest = std::max(widest, width + labels + (labels > 0 ? 7 : 0));
        }
        return widest + (column > 0 ? gap : 0);
    }

    RowHeights rowHeights(std::size_t row, double side) const {
        RowHeights heights{0, 6, 8};
        for (std::size_t i = row * columns_; i < std::min((row + 1) * columns_, panels_.size()); ++i) {
            const Figure& panel = *panels_[i];
            const FigureRange& range = ranges_[i];
            double height = std::clamp(0.78 * side, 170.0, 380.0);
            if (panel.map)
                height = hasAxes(panel) ? side * (range.y_max - range.y_min) / (range.x_max - range.x_min) : side;
            heights.frame = std::max(heights.frame, height);
            if (!figure_.panels.empty() && !panel.title.empty()) heights.above = heading_line + 4;
            if (y_ticks_[i].factor != 0 && showsY(i)) heights.above = std::max(heights.above, heading_line + 18);
            if (showsX(i)) heights.below = tick_line + label_line + 8;
        }
        return heights;
    }

    void drawPanel(std::vector<Shape>& shapes, std::size_t i, const Rect& frame) {
        const Figure& panel = *panels_[i];
        const double factor_line = y_ticks_[i].factor != 0 && showsY(i) ? 16 : 0;
        if (!figure_.panels.empty())
            shapes.push_back(Text{{0.5 * (frame.left + frame.right), frame.top - 6 - factor_line},
                                  panel.title,
                                  heading_size,
                                  Anchor::middle,
                                  ink,
                                  true});
        if (panel.map && draws_maps_) drawMap(shapes, *panel.map, color_, frame);
        if (!hasAxes(panel)) return;
        const PlotArea plot(panel, frame, ranges_[i], x_ticks_[i], y_ticks_[i]);
        if (!panel.map) plot.drawGrid(shapes);
        DrawnData data;
        plot.drawSeries(shapes, data);
        plot.drawAxes(shapes);
        if (panel.map) drawScaleBar(shapes, *panel.map, panel.x.unit, frame);
        if (showsX(i)) {
            shapes.push_back(Text{{0.5 * (frame.left + frame.right), frame.bottom + tick_line + 15},
                                  axisText(panel.x),
                                  label_size - 1,
                                  Anchor::middle,
                                  ink});
            if (x_ticks_[i].factor != 0)
                drawFactor(shapes, {frame.right - 40, frame.bottom + tick_line + 15}, x_ticks_[i].factor);
        }
        if (factor_line > 0) drawFactor(shapes, {frame.left, frame.top - 6}, y_ticks_[i].factor);
        if (!labelsY(i)) return;
        double labels = 0;
        for (const Tick& tick : y_ticks_[i].ticks) labels = std::max(labels, labelWidth(tick));
        shapes.push_back(Text{{frame.left - 7 - labels - 8, 0.5 * (frame.top + frame.bottom)},
                              axisText(panel.y),
                              label_size - 1,
                              Anchor::middle,
                              ink,
                              false,
                              true});
    }

    // What several panels show has one entry.
    std::vector<LegendEntry> legend() const {
        std::vector<LegendEntry> entries;
        std::set<std::string> known;
        for (const Figure* panel : panels_)
            for (LegendEntry& entry : legendEntries(*panel))
                if (known.insert(entry.label).second) entries.push_back(std::move(entry));
        return entries;
    }

    const Figure& figure_;
    std::vector<const Figure*> panels_;
    std::size_t columns_ = 1, rows_ = 1;
    bool has_bar_ = false, draws_maps_ = true;
    Axis color_;
    std::vector<FigureRange> ranges_;
    std::vector<AxisTicks> x_ticks_, y_ticks_;
};

}  // namespace

Drawing layoutPanels(const Figure& figure, double width, bool maps) { return Page(figure).draw(width, maps); }

}  // namespace searchlight
