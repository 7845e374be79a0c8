#include "plot/fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace searchlight {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
// A datum of a larger error says nothing about a difference of percents.
constexpr double largest_error = 0.5;

double errorOf(const FitPicture& channel, std::size_t i) {
    return channel.standard_error.empty() ? 0 : channel.standard_error[i];
}

bool known(const FitPicture& channel, std::size_t i) {
    return channel.value[i] > 0 && errorOf(channel, i) < largest_error * channel.value[i];
}

std::string named(const std::string& what, const FitPicture& channel) {
    return channel.label.empty() ? what : what + ", " + channel.label;
}

}  // namespace

Figure fitFigure(std::span<const FitPicture> channels, const std::string& title, const std::string& model) {
    Figure curves;
    curves.y = {"Diffuse reflectance", "1/mm²", AxisScale::logarithmic};
    Figure residual;
    residual.y = {"(fit − data) / data", "%", AxisScale::linear};
    std::vector<double> sizes;
    double top = 0, bottom = std::numeric_limits<double>::infinity(), right = 0;
    bool errors = false;
    for (const FitPicture& channel : channels) {
        Series data{.label = "data", .style = SeriesStyle::points, .in_legend = &channel == &channels.front()};
        Series left{.label = named("difference", channel), .color = channel.color};
        Series band{.label = named("data", channel), .in_legend = false};
        for (std::size_t i = 0; i < channel.value.size(); ++i) {
            right = std::max(right, channel.edges_mm.empty() ? channel.radii_mm[i] : channel.edges_mm[i + 1]);
            const bool shown = known(channel, i);
            const double relative = shown ? 100 * channel.relative[i] : nan;
            left.x.push_back(channel.radii_mm[i]);
            left.y.push_back(relative);
            const double half = 200 * errorOf(channel, i) / channel.value[i];
            band.x.push_back(channel.radii_mm[i]);
            band.y.push_back(shown ? 0 : nan);
            band.lower.push_back(shown ? -half : nan);
            band.upper.push_back(shown ? half : nan);
            if (!shown) continue;
            sizes.push_back(std::abs(relative));
            data.x.push_back(channel.radii_mm[i]);
            data.y.push_back(channel.value[i]);
            top = std::max(top, channel.value[i]);
            bottom = std::min(bottom, channel.value[i]);
            if (channel.standard_error.empty()) continue;
            errors = true;
            data.lower.push_back(channel.value[i] - 2 * errorOf(channel, i));
            data.upper.push_back(channel.value[i] + 2 * errorOf(channel, i));
        }
        if (channel.standard_error.empty()) band.lower = band.upper = {};
        curves.series.push_back(std::move(data));
        curves.series.push_back(
            {.label = named(model, channel), .x = channel.curve_mm, .y = channel.curve, .color = channel.color});
        residual.series.push_back(std::move(band));
        left.in_legend = false;
        residual.series.push_back(std::move(left));
    }
    // Nine tenths of the differences decide the view.
    double view = 1;
    if (!sizes.empty()) {
        const auto rank = sizes.begin() + static_cast<std::ptrdiff_t>(0.9 * static_cast<double>(sizes.size() - 1));
        std::nth_element(sizes.begin(), rank, sizes.end());
        view = std::clamp(1.5 * *rank, 1e-9, 100.0);
    }
    residual.y.min = -view;
    residual.y.max = view;
    curves.y.max = 2 * top;
    curves.y.min = bottom / 2;
    curves.x = residual.x = {"Radius", "mm", AxisScale::square_root, 0, right};
    Figure figure;
    figure.title = title;
    figure.caption = "Per unit flux that has entered the medium.";
    if (errors) figure.caption += " Bars and band: ±2 standard errors of the data.";
    figure.panels = {std::move(curves), std::move(residual)};
    return figure;
}

}  // namespace searchlight
