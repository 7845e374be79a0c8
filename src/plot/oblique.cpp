#include "plot/oblique.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/text.h"

namespace searchlight {

namespace {

// Beyond this relative standard error a bin of the reference does not decide what the axis shows.
constexpr double largest_error = 0.5;

void check(const StripPanel& panel) {
    const std::size_t cells = panel.edges_mm.empty() ? 0 : panel.edges_mm.size() - 1;
    if (cells == 0) throw inputError("a strip without cells");
    for (const StripCurve& curve : panel.models)
        if (curve.means.size() != cells)
            throw inputError(fmt::format("model '{}' has {} means for {} cells of the strip", curve.label,
                                         curve.means.size(), cells));
    for (const StripReference& reference : panel.reference)
        if (reference.Rd.size() != cells || reference.standard_error.size() != cells)
            throw inputError(
                fmt::format("reference '{}' has {} values and {} standard errors for {} cells of the strip",
                            reference.label, reference.Rd.size(), reference.standard_error.size(), cells));
    if (panel.models.empty() && panel.reference.empty()) throw inputError("no model and no reference to plot");
}

Figure panelFigure(const StripPanel& panel, const ObliqueOptions& options) {
    Figure figure;
    figure.title = panel.heading;
    figure.x = {"x, along the beam's lean", "mm", AxisScale::linear, panel.edges_mm.front(), panel.edges_mm.back()};
    figure.y = {"Diffuse reflectance", "1/mm²", options.y_scale};
    int color = -1;
    for (const StripCurve& curve : panel.models) {
        if (!curve.dashed || color < 0) ++color;
        Series series{.label = curve.label, .color = color, .dashed = curve.dashed};
        for (std::size_t i = 0; i < curve.means.size(); ++i) {
            series.x.push_back(0.5 * (panel.edges_mm[i] + panel.edges_mm[i + 1]));
            series.y.push_back(pick(curve.means[i], options.channel));
        }
        figure.series.push_back(std::move(series));
    }
    for (const StripReference& reference : panel.reference) {
        Series series{.label = reference.label, .style = SeriesStyle::steps, .x = panel.edges_mm};
        for (std::size_t i = 0; i < reference.Rd.size(); ++i) {
            const double mean = pick(reference.Rd[i], options.channel);
            const double half = options.band_sigmas * pickError(reference.standard_error[i], options.channel);
            series.y.push_back(mean);
            series.lower.push_back(mean - half);
            series.upper.push_back(mean + half);
        }
        figure.series.push_back(std::move(series));
    }
    return figure;
}

struct Range {
    double min = INFINITY, max = 0;
};

// What the ordinate should show: where the reference is known, and the models there; without one five decades.
Range ordinateRange(const Figure& panel, const ObliqueOptions& options) {
    Range reference, models;
    for (const Series& series : panel.series)
        for (std::size_t i = 0; i < series.y.size(); ++i) {
            const double y = series.y[i];
            if (!(y > 0) || !std::isfinite(y)) continue;
            Range& range = series.lower.empty() ? models : reference;
            range.max = std::max(range.max, y);
            const double error = series.lower.empty() ? 0 : (series.upper[i] - y) / options.band_sigmas;
            if (error <= largest_error * y) range.min = std::min(range.min, y);
        }
    if (reference.max > 0)
        return {0.5 * reference.min, std::min(std::max(models.max, reference.max), 10 * reference.max)};
    return {std::max(models.min, 1e-5 * models.max), models.max};
}

}  // namespace

Figure obliqueFigure(std::span<const StripPanel> panels, const ObliqueOptions& options) {
    if (panels.empty()) throw inputError("no angle to plot");
    if (!(options.band_sigmas > 0))
        throw inputError(fmt::format("a band of {} standard errors is not positive", options.band_sigmas));
    Figure figure;
    std::vector<Figure> plots;
    Range shared;
    for (const StripPanel& panel : panels) {
        check(panel);
        plots.push_back(panelFigure(panel, options));
        const Range own = ordinateRange(plots.back(), options);
        shared = {std::min(shared.min, own.min), std::max(shared.max, own.max)};
        if (options.shared_ordinate) continue;
        plots.back().y.min = options.y_scale == AxisScale::logarithmic ? own.min / 1.3 : 0;
        plots.back().y.max = 1.5 * own.max;
    }
    if (options.shared_ordinate && shared.max > 0)
        for (Figure& plot : plots) {
            const bool logarithmic = options.y_scale == AxisScale::logarithmic;
            plot.y.min = logarithmic ? shared.min / 1.3 : 0;
            plot.y.max = (logarithmic ? 1.5 : 1.06) * shared.max;
        }
    if (plots.size() == 1) {
        figure = std::move(plots.front());
        figure.title = options.title + (panels[0].heading.empty() ? "" : ", " + panels[0].heading);
    } else {
        figure.title = options.title;
        figure.columns = plots.size() == 3 || plots.size() > 4 ? 3 : 2;
        figure.panels = std::move(plots);
    }
    const bool has_reference =
        std::any_of(panels.begin(), panels.end(), [](const StripPanel& panel) { return !panel.reference.empty(); });
    figure.caption = fmt::format(
        "Per unit incident flux: Fresnel transmission of the beam included, specular reflection apart. The beam enters "
        "at 0 and leans to the right. Means over the cells of the strip |y| < {} mm{}.",
        prettyNumber(panels[0].half_width_mm, 3),
        has_reference ? fmt::format("; band: ±{} standard errors of the reference", prettyNumber(options.band_sigmas))
                      : "");
    return figure;
}

StripShape stripShape(std::span<const Rgb> means, std::span<const double> edges_mm, PlotChannel channel) {
    StripShape shape;
    double flux = 0, moment = 0;
    for (std::size_t i = 0; i < means.size(); ++i) {
        const double value = pick(means[i], channel), middle = 0.5 * (edges_mm[i] + edges_mm[i + 1]);
        const double part = value * (edges_mm[i + 1] - edges_mm[i]);
        flux += part;
        moment += part * middle;
        if (value <= shape.peak) continue;
        shape.peak = value;
        shape.peak_x_mm = middle;
    }
    shape.mean_x_mm = flux > 0 ? moment / flux : 0;
    return shape;
}

}  // namespace searchlight
