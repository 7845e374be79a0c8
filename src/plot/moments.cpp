#include "plot/moments.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"

namespace searchlight {

namespace {

void checkSize(const std::string& label, std::size_t count, std::size_t angles) {
    if (count != angles) throw inputError(fmt::format("'{}' has {} moments for {} angles", label, count, angles));
}

Figure panel(const std::string& heading, const Axis& y, std::span<const double> angles_deg,
             std::span<const MomentCurve> models, std::vector<double> MomentCurve::*values,
             const std::vector<Estimate>* reference, const std::string& label) {
    Figure figure;
    figure.title = heading;
    // Room for points at both ends.
    const auto [first, last] = std::minmax_element(angles_deg.begin(), angles_deg.end());
    const double room = 0.04 * std::max(*last - *first, 10.0);
    figure.x = {"Angle of incidence", "deg", AxisScale::linear, *first - room, *last + room};
    figure.y = y;
    const std::vector<double> angles(angles_deg.begin(), angles_deg.end());
    int color = 0;
    for (const MomentCurve& model : models) {
        checkSize(model.label, (model.*values).size(), angles.size());
        figure.series.push_back({.label = model.label, .x = angles, .y = model.*values, .color = color++});
    }
    if (!reference) return figure;
    checkSize(label, reference->size(), angles.size());
    Series points{.label = label, .style = SeriesStyle::points, .x = angles};
    for (const Estimate& estimate : *reference) {
        points.y.push_back(estimate.mean);
        points.lower.push_back(estimate.mean - 2 * estimate.standard_error);
        points.upper.push_back(estimate.mean + 2 * estimate.standard_error);
    }
    figure.series.push_back(std::move(points));
    return figure;
}

}  // namespace

Figure momentsFigure(std::span<const double> angles_deg, std::span<const MomentCurve> models,
                     const MomentReference* reference, const std::string& title) {
    if (angles_deg.empty()) throw inputError("no angle to plot");
    if (models.empty() && !reference) throw inputError("no model and no reference to plot");
    Figure figure;
    figure.title = title;
    figure.columns = 2;
    const std::string label = reference ? reference->label : "";
    figure.panels.push_back(panel("Mean shift ⟨x⟩", {"⟨x⟩", "mm"}, angles_deg, models, &MomentCurve::mean_x_mm,
                                  reference ? &reference->mean_x_mm : nullptr, label));
    figure.panels.push_back(panel("Mean square radius ⟨r²⟩", {"⟨r²⟩", "mm²"}, angles_deg, models,
                                  &MomentCurve::mean_r2_mm2, reference ? &reference->mean_r2_mm2 : nullptr, label));
    figure.caption =
        "Means over all light that leaves after scattering. x: along the beam's lean; r: distance from the entry "
        "point.";
    if (reference) figure.caption += " Bars: ±2 standard errors.";
    return figure;
}

}  // namespace searchlight
