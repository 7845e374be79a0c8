#include "plot/error_over_time.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"

namespace searchlight {

namespace {

// Lines have six colours; the next six techniques are dashed.
constexpr std::size_t colors = 6;

struct Range {
    double min = std::numeric_limits<double>::infinity(), max = 0;

    void add(double value) {
        if (!(value > 0)) return;
        min = std::min(min, value);
        max = std::max(max, value);
    }
    // So that no point lies on the frame.
    void widen() {
        min /= 1.3;
        max *= 1.3;
    }
};

void addSeries(Figure& figure, const TimedErrors& technique, bool in_legend) {
    Series line{.label = technique.label,
                .color = static_cast<int>(technique.color % colors),
                .dashed = technique.color >= colors,
                .in_legend = in_legend};
    Series points{.label = technique.label, .style = SeriesStyle::points, .color = line.color, .in_legend = false};
    for (std::size_t i = 0; i < technique.time_ms.size(); ++i) {
        if (!(technique.error[i] > 0)) continue;
        line.x.push_back(technique.time_ms[i]);
        line.y.push_back(100 * technique.error[i]);
        points.lower.push_back(100 * technique.lower[i]);
        points.upper.push_back(100 * technique.upper[i]);
    }
    points.x = line.x;
    points.y = line.y;
    if (line.x.empty()) return;
    figure.series.push_back(std::move(line));
    figure.series.push_back(std::move(points));
}

}  // namespace

Figure errorOverTimeFigure(const std::vector<TimedPanel>& panels, const std::vector<ErrorLevel>& levels,
                           const std::string& title, const std::string& error_label) {
    Range time, error;
    for (const TimedPanel& panel : panels)
        for (const TimedErrors& technique : panel.techniques)
            for (std::size_t i = 0; i < technique.time_ms.size(); ++i) {
                time.add(technique.time_ms[i]);
                error.add(100 * technique.error[i]);
            }
    if (time.max == 0 || error.max == 0) throw inputError("no technique has an error and a time to plot");
    for (const ErrorLevel& level : levels) error.add(100 * level.error);
    time.widen();
    error.widen();

    Figure figure;
    figure.title = title;
    std::vector<std::string> seen;
    for (const TimedPanel& panel : panels) {
        Figure plot;
        plot.title = panel.title;
        plot.x = {"Time of a picture", "ms", AxisScale::logarithmic, time.min, time.max};
        plot.y = {error_label, "%", AxisScale::logarithmic, error.min, error.max};
        for (const TimedErrors& technique : panel.techniques) {
            const bool known = std::ranges::find(seen, technique.label) != seen.end();
            addSeries(plot, technique, !known);
            seen.push_back(technique.label);
        }
        for (const ErrorLevel& level : levels) {
            if (!(level.error > 0)) continue;
            const bool known = std::ranges::find(seen, level.label) != seen.end();
            plot.series.push_back({.label = level.label,
                                   .x = {time.min, time.max},
                                   .y = {100 * level.error, 100 * level.error},
                                   .color = neutral_color,
                                   .dashed = level.label != levels.front().label,
                                   .in_legend = !known});
            seen.push_back(level.label);
        }
        figure.panels.push_back(std::move(plot));
    }
    if (figure.panels.size() > 1) {
        figure.columns = static_cast<int>(figure.panels.size());
        return figure;
    }
    Figure only = std::move(figure.panels.front());
    only.title = title;
    return only;
}

}  // namespace searchlight
