#include "job/plot/plane_views.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/text.h"

namespace searchlight {

namespace {

constexpr double not_applicable = std::numeric_limits<double>::quiet_NaN();

}  // namespace

std::vector<PlaneCell> Strip::cells() const {
    std::vector<PlaneCell> list;
    for (std::size_t i = 0; i + 1 < edges_mm.size(); ++i)
        list.push_back({edges_mm[i], edges_mm[i + 1], -half_width_mm, half_width_mm});
    return list;
}

Strip stripOf(const Medium& medium, double extent_mm, double half_width_mm, int cells) {
    double extent = extent_mm;
    if (extent <= 0)
        for (int c = 0; c < medium.channels; ++c) {
            if (!medium.scatters(c)) continue;
            const double sigma_tp = medium.sigmaTp()[c], sigma_tr = std::sqrt(3 * medium.sigma_a[c] * sigma_tp);
            extent = std::max(extent, std::min(4 / std::max(sigma_tr, 1e-30), 12 / sigma_tp));
        }
    Strip strip;
    strip.half_width_mm = half_width_mm > 0 ? half_width_mm : extent / 80;
    // A third of the mean width at the entry point, where R_d is steepest.
    constexpr double slope = 1.0 / 3;
    const int half = cells / 2;
    for (int i = -half; i <= half; ++i) {
        const double t = std::abs(static_cast<double>(i)) / half;
        strip.edges_mm.push_back(std::copysign(extent * t * (slope + (1 - slope) * t), i));
    }
    return strip;
}

std::vector<Rgb> tallyValues(const ReferenceRun& run, HalfSpaceTally HalfSpaceResult::*order,
                             std::vector<double> HalfSpaceTally::*list) {
    std::vector<Rgb> values;
    for (int c = 0; c < Rgb::channels; ++c) {
        const auto& walked = run.channels[run.medium.channels == 1 ? 0 : static_cast<std::size_t>(c)];
        if (!walked) continue;
        const std::vector<double>& channel = *walked.*order.*list;
        values.resize(channel.size(), {not_applicable, not_applicable, not_applicable});
        for (std::size_t i = 0; i < channel.size(); ++i) values[i][c] = channel[i];
    }
    return values;
}

StripReference stripReference(const ReferenceRun& run) {
    return {walksLabel(run), tallyValues(run, &HalfSpaceResult::all, &HalfSpaceTally::strip),
            tallyValues(run, &HalfSpaceResult::all, &HalfSpaceTally::strip_standard_error)};
}

std::vector<Rgb> incidentCellMeans(LoadedModel& loaded, double angle_deg, const std::vector<PlaneCell>& cells) {
    const double entry = pencilBeam(loaded.medium.eta, angle_deg).transmittance;
    std::vector<Rgb> means = cellMeans(*loaded.evaluator, loaded.model, loaded.medium, angle_deg, cells);
    for (Rgb& value : means)
        for (int c = 0; c < Rgb::channels; ++c)
            value[c] = loaded.medium.scatters(c) ? entry * value[c] : not_applicable;
    return means;
}

std::vector<PlaneCell> squareCells(double extent_mm, int cells) {
    std::vector<PlaneCell> list;
    const auto edge = [&](int i) { return extent_mm * (2.0 * i / cells - 1); };
    for (int j = 0; j < cells; ++j)
        for (int i = 0; i < cells; ++i) list.push_back({edge(i), edge(i + 1), edge(j), edge(j + 1)});
    return list;
}

std::vector<SlicePanel> slicePanels(std::vector<LoadedModel>& models, double angle_deg, double extent_mm, int cells,
                                    const ReferenceRun* run) {
    std::vector<SlicePanel> panels;
    const std::vector<PlaneCell> square = squareCells(extent_mm, cells);
    for (LoadedModel& loaded : models) {
        SlicePanel panel{.heading = modelLabel(loaded), .means = incidentCellMeans(loaded, angle_deg, square)};
        const auto& parameters = loaded.model.file.parameters;
        const bool clamps = std::ranges::any_of(parameters, [](const Param& p) { return p.name == "ClampNegative"; });
        if (clamps && !loaded.parameters.contains("ClampNegative")) {
            ParamValues signed_values = loaded.parameters;
            signed_values["ClampNegative"] = false;
            loaded.evaluator->set(loaded.medium, signed_values);
            panel.unclamped = incidentCellMeans(loaded, angle_deg, square);
            loaded.evaluator->set(loaded.medium, loaded.parameters);
        }
        panels.push_back(std::move(panel));
    }
    if (run)
        panels.push_back({walksLabel(*run),
                          tallyValues(*run, &HalfSpaceResult::all, &HalfSpaceTally::grid),
                          tallyValues(*run, &HalfSpaceResult::all, &HalfSpaceTally::grid_standard_error),
                          {}});
    return panels;
}

void walkOnly(PlotChannel channel, ReferenceOptions& options) {
    for (int c = 0; c < Rgb::channels; ++c)
        options.only[c] = channel == PlotChannel::luminance || c == static_cast<int>(channel);
}

void requireScattering(const Subject& subject, PlotChannel channel) {
    if (channel == PlotChannel::luminance || subject.medium.channels == 1 ||
        subject.medium.scatters(static_cast<int>(channel)))
        return;
    throw inputError(fmt::format("{} does not scatter in channel {}: there is nothing to plot", subject.name,
                                 "RGB"[static_cast<int>(channel)]),
                     "choose another --channel");
}

int channelIndex(const Medium& medium, PlotChannel channel) {
    return medium.channels == 1 || channel == PlotChannel::luminance ? 0 : static_cast<int>(channel);
}

std::string walksLabel(const ReferenceRun& run) {
    std::uint64_t walks = 0;
    for (const auto& channel : run.channels)
        if (channel) walks = channel->walks;
    return fmt::format("Monte Carlo, {} walks", countText(static_cast<double>(walks)));
}

}  // namespace searchlight
