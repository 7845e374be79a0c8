#include "plot/albedo.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/text.h"

namespace searchlight {

namespace {

void checkSizes(const std::string& label, size_t albedos, size_t totals) {
    if (albedos != totals)
        throw inputError(fmt::format("curve '{}' has {} totals for {} albedos", label, totals, albedos));
}

}  // namespace

Figure albedoFigure(std::span<const AlbedoCurve> models, const AlbedoReference* reference, double eta) {
    if (models.empty() && !reference) throw inputError("no model and no reference to plot");
    Figure figure;
    figure.title = fmt::format("Total diffuse reflectance, relative index {}", prettyNumber(eta));
    figure.caption =
        "Light at normal incidence, per unit incident flux: Fresnel transmission included, specular reflection apart.";
    figure.x = {"Reduced albedo α′", "", AxisScale::linear, 0, 1};
    figure.y = {"Total diffuse reflectance", "", AxisScale::linear, 0, 1};
    for (size_t i = 0; i < models.size(); ++i) {
        // A model may exceed energy; that must be seen.
        for (const double total : models[i].total)
            if (std::isfinite(total)) figure.y.max = std::max(figure.y.max, 1.05 * total);
        checkSizes(models[i].label, models[i].albedo.size(), models[i].total.size());
        figure.series.push_back(
            {.label = models[i].label, .x = models[i].albedo, .y = models[i].total, .color = static_cast<int>(i)});
    }
    if (!reference) return figure;

    checkSizes(reference->label, reference->albedo.size(), reference->total.size());
    Series points{.label = reference->label, .style = SeriesStyle::points, .x = reference->albedo};
    bool exact = true;
    for (const Estimate& total : reference->total) {
        points.y.push_back(total.mean);
        points.lower.push_back(total.mean - 2 * total.standard_error);
        points.upper.push_back(total.mean + 2 * total.standard_error);
        exact = exact && total.standard_error == 0;
    }
    if (exact)
        points.lower = points.upper = {};
    else
        figure.caption += " Bars: ±2 standard errors.";
    figure.series.push_back(std::move(points));
    return figure;
}

}  // namespace searchlight
