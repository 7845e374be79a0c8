#include "plot/slice.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/text.h"

namespace searchlight {

namespace {

std::size_t sideOf(std::span<const SlicePanel> panels) {
    const std::size_t count = panels.front().means.size();
    const auto side = static_cast<std::size_t>(std::lround(std::sqrt(static_cast<double>(count))));
    if (side < 2 || side * side != count)
        throw inputError(fmt::format("'{}' has {} cells, which are no square", panels.front().heading, count));
    for (const SlicePanel& panel : panels) {
        const auto fits = [&](const std::vector<Rgb>& list) { return list.empty() || list.size() == count; };
        if (panel.means.size() != count || !fits(panel.standard_error) || !fits(panel.unclamped))
            throw inputError(fmt::format("'{}' has {} cells, expected {}", panel.heading, panel.means.size(), count));
    }
    return side;
}

// A third of the side or less: 1, 2 or 5 times a power of ten.
double niceLength(double extent) {
    const double wanted = 2 * extent / 3, power = std::pow(10.0, std::floor(std::log10(wanted)));
    return power * (wanted >= 5 * power ? 5 : wanted >= 2 * power ? 2 : 1);
}

}  // namespace

Contour zeroContour(std::span<const double> values, std::size_t cells, double extent) {
    Contour contour;
    const double side = 2 * extent / static_cast<double>(cells);
    struct Corner {
        double x, y, value;
    };
    const auto corner = [&](std::size_t i, std::size_t j) {
        return Corner{-extent + (static_cast<double>(i) + 0.5) * side, -extent + (static_cast<double>(j) + 0.5) * side,
                      values[j * cells + i]};
    };
    const auto isNegative = [](const Corner& c) { return c.value < 0; };
    for (std::size_t j = 0; j + 1 < cells; ++j)
        for (std::size_t i = 0; i + 1 < cells; ++i) {
            const std::array<Corner, 4> around{corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)};
            std::array<std::array<double, 2>, 4> crossings{};
            std::size_t count = 0;
            for (std::size_t k = 0; k < 4; ++k) {
                const Corner &a = around[k], &b = around[(k + 1) % 4];
                if (isNegative(a) == isNegative(b)) continue;
                const double t = a.value / (a.value - b.value);
                crossings[count++] = {a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)};
            }
            // Four crossings are two pieces; which pairs they make is below the resolution.
            for (std::size_t k = 0; k + 1 < count; k += 2) {
                for (const std::size_t end : {k, k + 1}) {
                    contour.x.push_back(crossings[end][0]);
                    contour.y.push_back(crossings[end][1]);
                }
                contour.x.push_back(std::numeric_limits<double>::quiet_NaN());
                contour.y.push_back(std::numeric_limits<double>::quiet_NaN());
            }
        }
    return contour;
}

Figure sliceFigure(std::span<const SlicePanel> panels, const SliceOptions& options) {
    if (panels.empty()) throw inputError("no model and no reference to plot");
    const std::size_t side = sideOf(panels);
    std::vector<double> edges;
    for (std::size_t i = 0; i <= side; ++i)
        edges.push_back(options.extent_mm * (2 * static_cast<double>(i) / static_cast<double>(side) - 1));

    Figure figure;
    figure.title = options.title;
    figure.columns = options.columns;
    bool outlined = false, has_reference = false;
    double reference_top = 0, model_top = 0, model_low = INFINITY;
    for (const SlicePanel& panel : panels) {
        const bool is_reference = !panel.standard_error.empty();
        has_reference = has_reference || is_reference;
        Figure plot;
        plot.title = panel.heading;
        plot.x = {"x", "mm", AxisScale::linear, -options.extent_mm, options.extent_mm};
        plot.y = {"y", "mm", AxisScale::linear, -options.extent_mm, options.extent_mm};
        FalseColor map{.x_edges = edges, .y_edges = edges, .scale_bar = niceLength(options.extent_mm)};
        for (const Rgb& mean : panel.means) {
            map.values.push_back(pick(mean, options.channel));
            double& top = is_reference ? reference_top : model_top;
            const double value = map.values.back();
            if (!std::isfinite(value)) continue;
            top = std::max(top, value);
            if (!is_reference && value > 0) model_low = std::min(model_low, value);
        }
        for (const Rgb& error : panel.standard_error) map.standard_error.push_back(pickError(error, options.channel));
        if (!panel.unclamped.empty()) {
            std::vector<double> values;
            for (const Rgb& value : panel.unclamped) values.push_back(pick(value, options.channel));
            Contour contour = zeroContour(values, side, options.extent_mm);
            if (!contour.x.empty()) {
                outlined = true;
                plot.series.push_back({.label = "clamped to 0",
                                       .x = std::move(contour.x),
                                       .y = std::move(contour.y),
                                       .color = outline_color,
                                       .in_legend = false});
            }
        }
        plot.map = std::move(map);
        figure.panels.push_back(std::move(plot));
    }
    const double top = reference_top > 0 ? reference_top : model_top;
    if (!(top > 0)) throw inputError("nothing leaves the surface: there is nothing to plot");
    // Models are free of noise: below the lowest of their values there is nothing to see.
    const double lowest = top * std::pow(10.0, -options.decades);
    const double bottom = model_low < 0.5 * top ? std::max(lowest, model_low) : lowest;
    figure.color = {"Diffuse reflectance", "1/mm²", AxisScale::logarithmic, bottom, top};
    figure.caption =
        "Per unit incident flux, means over the cells. The beam enters in the middle and leans to the right.";
    figure.caption += " Values outside the scale have the colour of its end.";
    if (has_reference) figure.caption += " Monte Carlo: cells that no walk has left are dark.";
    if (outlined) figure.caption += " White outline: the model is negative within, and has been clamped to 0.";
    return figure;
}

}  // namespace searchlight
