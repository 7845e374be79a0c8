#include "plot/hemisphere.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace searchlight {

namespace {

std::vector<double> equalEdges(double end, int count) {
    std::vector<double> edges;
    for (int i = 0; i <= count; ++i) edges.push_back(end * i / count);
    return edges;
}

// Against the angle from the normal, positive on the side that the beam leans to: from the two cells beside the plane.
Series planeSeries(const HemispherePanel& panel, const HemisphereOptions& options, int color) {
    const bool is_reference = !panel.standard_error.empty();
    Series series{.label = panel.heading, .style = SeriesStyle::steps, .color = is_reference ? neutral_color : color};
    for (int i = -options.polar; i <= options.polar; ++i) series.x.push_back(90.0 * i / options.polar);
    for (int i = -options.polar; i < options.polar; ++i) {
        const int ring = i < 0 ? -1 - i : i, half = options.turns / 2;
        // Mirror images of each other: in the reference the same exits.
        const auto at = [&](int turn) { return static_cast<std::size_t>(ring * options.turns + turn); };
        const std::size_t a = i < 0 ? at(half) : at(0), b = i < 0 ? at(half - 1) : at(options.turns - 1);
        const auto mean = [&](const std::vector<Rgb>& list, auto value) {
            return 0.5 * (value(list[a], options.channel) + value(list[b], options.channel));
        };
        series.y.push_back(mean(panel.radiance, pick));
        if (!is_reference) continue;
        const double error = mean(panel.standard_error, pickError);
        series.lower.push_back(series.y.back() - 2 * error);
        series.upper.push_back(series.y.back() + 2 * error);
    }
    return series;
}

}  // namespace

Figure hemisphereFigure(std::span<const HemispherePanel> panels, const HemisphereOptions& options) {
    if (panels.empty()) throw inputError("no model and no reference to plot");
    if (options.turns % 2 != 0) throw inputError(fmt::format("{} cells of azimuth are not even", options.turns));
    const auto cells = static_cast<std::size_t>(options.polar) * static_cast<std::size_t>(options.turns);
    Figure figure;
    figure.title = options.title;
    Figure plane;
    plane.title = "In the plane of incidence";
    plane.x = {"Angle from the normal", "deg", AxisScale::linear, -90, 90};
    plane.y = {"Radiance", "1/(mm² sr)"};
    double top = 0;
    int color = 0;
    for (const HemispherePanel& panel : panels) {
        if (panel.radiance.size() != cells || (!panel.standard_error.empty() && panel.standard_error.size() != cells))
            throw inputError(
                fmt::format("'{}' has {} cells, expected {}", panel.heading, panel.radiance.size(), cells));
        Figure disc;
        disc.title = panel.heading;
        FalseColor map{
            .x_edges = equalEdges(360, options.turns), .y_edges = equalEdges(90, options.polar), .hemisphere = true};
        for (const Rgb& value : panel.radiance) {
            map.values.push_back(pick(value, options.channel));
            if (std::isfinite(map.values.back())) top = std::max(top, map.values.back());
        }
        for (const Rgb& value : panel.standard_error) map.standard_error.push_back(pickError(value, options.channel));
        disc.map = std::move(map);
        figure.panels.push_back(std::move(disc));
        plane.series.push_back(planeSeries(panel, options, panel.standard_error.empty() ? color++ : 0));
    }
    if (!(top > 0)) throw inputError("nothing leaves here: there is nothing to plot");
    plane.y.max = 1.05 * top;
    figure.color = {"Radiance", "1/(mm² sr)", AxisScale::linear, 0, top};
    figure.panels.push_back(std::move(plane));
    figure.columns = figure.panels.size() > 6 ? 4 : figure.panels.size() > 4 || figure.panels.size() == 3 ? 3 : 2;
    figure.caption = fmt::format(
        "Radiance that leaves {}, per unit incident flux. Discs: the hemisphere from above, the polar angle from the "
        "middle "
        "(rings: 30° and 60°), the beam leans to the right. Models: means over the same place and cells; those without "
        "an "
        "outgoing direction leave R_d T21/(π 4C_φ). Band: ±2 standard errors of the reference.",
        options.place);
    return figure;
}

}  // namespace searchlight
