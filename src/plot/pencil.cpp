#include "plot/pencil.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/text.h"

namespace searchlight {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// How a channel is drawn when all three stand side by side: vermilion, green, blue of the palette.
struct ChannelLook {
    PlotChannel channel;
    std::string_view name;
    int color;
};
constexpr std::array<ChannelLook, 3> rgb_looks{
    {{PlotChannel::red, "red", 3}, {PlotChannel::green, "green", 2}, {PlotChannel::blue, "blue", 0}}};

double radiusFactor(double x_mm, int power) { return std::pow(std::abs(x_mm), power); }

void checkOptions(const PencilOptions& options) {
    if (options.radius_power < 0 || options.radius_power > 2)
        throw inputError(fmt::format("radius power {} is not 0, 1 or 2", options.radius_power));
    if (!(options.band_sigmas > 0))
        throw inputError(fmt::format("a band of {} standard errors is not positive", options.band_sigmas));
}

void checkReference(const PencilReference& reference) {
    const size_t bins = reference.Rd.size();
    if (reference.edges_mm.size() != bins + 1 || reference.standard_error.size() != bins)
        throw inputError(fmt::format("reference '{}' has {} edges and {} standard errors for {} values",
                                     reference.label, reference.edges_mm.size(), reference.standard_error.size(), bins),
                         "n values need n + 1 edges and n standard errors");
}

void checkCurve(const PencilCurve& curve, const PencilReference* reference) {
    if (curve.x_mm.size() != curve.Rd.size())
        throw inputError(
            fmt::format("model '{}' has {} values at {} radii", curve.label, curve.Rd.size(), curve.x_mm.size()));
    if (reference && !curve.bin_means.empty() && curve.bin_means.size() != reference->Rd.size())
        throw inputError(fmt::format("model '{}' has {} bin means for {} annuli of the reference", curve.label,
                                     curve.bin_means.size(), reference->Rd.size()));
}

struct Shown {
    const PencilCurve* curve;
    int color;  // by place among all models: soloing one does not recolour it
};

std::vector<Shown> shownModels(std::span<const PencilCurve> models, const PencilReference* reference,
                               const PencilOptions& options) {
    std::vector<Shown> shown;
    std::vector<std::string> labels;
    for (size_t i = 0; i < models.size(); ++i) {
        checkCurve(models[i], reference);
        labels.push_back(models[i].label);
        if (options.solo.empty() || options.solo == models[i].label) shown.push_back({&models[i], static_cast<int>(i)});
    }
    if (!options.solo.empty() && shown.empty())
        throw unknownName(ErrorKind::input, "model to solo", options.solo, labels);
    return shown;
}

std::string incidence(double angle_deg) {
    return angle_deg == 0 ? "normal incidence" : fmt::format("incident at {}°", prettyNumber(angle_deg));
}

std::string titleText(std::string_view subject, const PencilOptions& options, bool channels_apart) {
    std::string title(subject);
    if (!options.material.empty()) title += " for " + options.material;
    if (!channels_apart) title += fmt::format(", {}", channelName(options.channel));
    return title + ", " + incidence(options.angle_deg);
}

Axis radiusAxis(const PencilOptions& options) { return {"Radius", "mm", options.x_scale}; }

Axis reflectanceAxis(const PencilOptions& options) {
    constexpr std::array<std::string_view, 3> names{"Diffuse reflectance", "Radius × diffuse reflectance",
                                                    "Radius² × diffuse reflectance"};
    constexpr std::array<std::string_view, 3> units{"1/mm²", "1/mm", ""};
    const size_t power = static_cast<size_t>(options.radius_power);
    return {std::string(names[power]), std::string(units[power]), options.y_scale};
}

Series modelSeries(const PencilCurve& curve, PlotChannel channel, int radius_power) {
    Series series{.label = curve.label, .x = curve.x_mm};
    for (size_t i = 0; i < curve.x_mm.size(); ++i)
        series.y.push_back(pick(curve.Rd[i], channel) * radiusFactor(curve.x_mm[i], radius_power));
    return series;
}

Series referenceSeries(const PencilReference& reference, PlotChannel channel, const PencilOptions& options) {
    Series series{.label = reference.label, .style = SeriesStyle::steps, .x = reference.edges_mm};
    for (size_t i = 0; i < reference.Rd.size(); ++i) {
        const double middle = 0.5 * (reference.edges_mm[i] + reference.edges_mm[i + 1]);
        const double factor = radiusFactor(middle, options.radius_power);
        const double mean = pick(reference.Rd[i], channel);
        const double half = options.band_sigmas * pickError(reference.standard_error[i], channel);
        series.y.push_back(mean * factor);
        series.lower.push_back((mean - half) * factor);
        series.upper.push_back((mean + half) * factor);
    }
    return series;
}

// A curve's value at x, linear between its points; NaN outside.
double valueAt(const Series& series, double x) {
    const auto right = std::lower_bound(series.x.begin(), series.x.end(), x);
    if (right == series.x.end() || (right == series.x.begin() && *right != x)) return nan;
    const size_t i = static_cast<size_t>(right - series.x.begin());
    if (*right == x) return series.y[i];
    const double t = (x - series.x[i - 1]) / (series.x[i] - series.x[i - 1]);
    return series.y[i - 1] + t * (series.y[i] - series.y[i - 1]);
}

// Beyond this relative standard error, a ratio to the reference says nothing.
constexpr double largest_error = 0.5;

bool isKnown(double mean, double standard_error) { return mean > 0 && standard_error <= largest_error * mean; }

// Where a bin is too wide for the curve to stand for its mean, the mean is marked beside the reference.
constexpr double worth_marking = 0.05;

Series meanSeries(const PencilCurve& curve, const Series& drawn, const PencilReference& reference, PlotChannel channel,
                  int radius_power) {
    Series series{.label = curve.label + ", mean over the annulus", .style = SeriesStyle::points, .in_legend = false};
    for (size_t i = 0; i < curve.bin_means.size(); ++i) {
        if (!isKnown(pick(reference.Rd[i], channel), pickError(reference.standard_error[i], channel))) continue;
        const double middle = 0.5 * (reference.edges_mm[i] + reference.edges_mm[i + 1]);
        const double mean = pick(curve.bin_means[i], channel) * radiusFactor(middle, radius_power);
        const double value = valueAt(drawn, middle);
        if (std::abs(mean - value) <= worth_marking * std::abs(mean)) continue;
        series.x.push_back(middle);
        series.y.push_back(mean);
    }
    return series;
}

// A logarithmic ordinate: the decades where something is known. From twice the top down to half the reference's last
// bin with an error below 50 %; without a reference six decades.
void chooseDecades(Figure& figure, double band_sigmas) {
    constexpr double decades = 1e-6, most_decades = 1e-10;
    double top = 0, reference_top = 0, bottom = INFINITY, known_bottom = INFINITY;
    for (const Series& series : figure.series) {
        for (size_t i = 0; i < series.y.size(); ++i) {
            const double y = series.y[i];
            if (!(y > 0) || !std::isfinite(y) || (figure.x.scale == AxisScale::logarithmic && !(series.x[i] >= 0)))
                continue;
            top = std::max(top, y);
            bottom = std::min(bottom, y);
            if (series.lower.empty()) continue;
            reference_top = std::max(reference_top, y);
            if (isKnown(y, (series.upper[i] - y) / band_sigmas)) known_bottom = std::min(known_bottom, y);
        }
    }
    if (top == 0) return;  // nothing positive: the drawing says so
    // Models may diverge at the source: one decade above the reference shows it.
    if (reference_top > 0) top = std::min(top, 10 * reference_top);
    if (std::isfinite(known_bottom))
        bottom = std::max(0.5 * known_bottom, most_decades * top);
    else
        bottom = std::max(bottom, decades * top);
    figure.y.max = 1.5 * top;
    figure.y.min = std::min(bottom, 0.1 * top) / 1.5;
}

// A logarithmic abscissa starts where something is known: at half the first edge that is not 0, or with the curves.
void chooseFirstRadius(Figure& figure) {
    double first = INFINITY, last = 0;
    for (const Series& series : figure.series)
        for (const double x : series.x) {
            if (!(x > 0)) continue;
            first = std::min(first, series.style == SeriesStyle::steps ? 0.5 * x : x);
            last = std::max(last, x);
        }
    if (first < last) figure.x.min = first, figure.x.max = last;
}

std::string bandText(const PencilOptions& options) {
    return fmt::format("{} standard errors", prettyNumber(options.band_sigmas));
}

bool channelsAgree(std::span<const Shown> shown, const PencilReference* reference) {
    const auto gray = [](const Rgb& v) { return v.r == v.g && v.g == v.b; };
    return std::all_of(
               shown.begin(), shown.end(),
               [&](const Shown& model) { return std::all_of(model.curve->Rd.begin(), model.curve->Rd.end(), gray); }) &&
           (!reference || std::all_of(reference->Rd.begin(), reference->Rd.end(), gray));
}

}  // namespace

Figure pencilFigure(std::span<const PencilCurve> models, const PencilReference* reference,
                    const PencilOptions& options) {
    checkOptions(options);
    if (reference) checkReference(*reference);
    const std::vector<Shown> shown = shownModels(models, reference, options);
    if (shown.empty() && !reference) throw inputError("no model and no reference to plot");
    const bool channels_apart = !options.solo.empty() && !channelsAgree(shown, reference);

    Figure figure;
    figure.title = titleText("Searchlight profile", options, channels_apart);
    figure.x = radiusAxis(options);
    figure.y = reflectanceAxis(options);
    bool means_marked = false;
    const auto addModel = [&](const Shown& model, PlotChannel channel, int color, std::string_view suffix) {
        Series curve = modelSeries(*model.curve, channel, options.radius_power);
        curve.color = color;
        Series means;
        if (reference) means = meanSeries(*model.curve, curve, *reference, channel, options.radius_power);
        curve.label += suffix;
        figure.series.push_back(std::move(curve));
        if (means.y.empty()) return;
        means.color = color;
        means.label += suffix;
        means_marked = true;
        figure.series.push_back(std::move(means));
    };
    if (channels_apart) {
        for (const ChannelLook& look : rgb_looks) {
            const std::string suffix = fmt::format(", {}", look.name);
            for (const Shown& model : shown) addModel(model, look.channel, look.color, suffix);
        }
        for (const ChannelLook& look : rgb_looks) {
            if (!reference) break;
            Series series = referenceSeries(*reference, look.channel, options);
            // One entry speaks for the three neutral curves.
            series.in_legend = look.channel == PlotChannel::red;
            if (!series.in_legend) series.label += fmt::format(", {}", look.name);
            figure.series.push_back(std::move(series));
        }
    } else {
        for (const Shown& model : shown) addModel(model, options.channel, model.color, "");
        if (reference) figure.series.push_back(referenceSeries(*reference, options.channel, options));
    }

    figure.caption = "Per unit incident flux: Fresnel transmission of the beam included, specular reflection apart.";
    if (reference)
        figure.caption += fmt::format(" Reference: mean over each annulus{}; band: ±{}.",
                                      options.radius_power > 0 ? ", times its middle radius" : "", bandText(options));
    if (options.angle_deg != 0) figure.caption += " Oblique light: averages over all directions about the beam.";
    if (means_marked)
        figure.caption += fmt::format(
            " Lines: models at a point; dots: their mean over the annulus, where it differs by more than {:.0f} %.",
            100 * worth_marking);
    if (figure.y.scale == AxisScale::logarithmic) chooseDecades(figure, options.band_sigmas);
    if (figure.x.scale == AxisScale::logarithmic) chooseFirstRadius(figure);
    return figure;
}

Figure relativeErrorFigure(std::span<const PencilCurve> models, const PencilReference& reference,
                           const PencilOptions& options) {
    checkOptions(options);
    checkReference(reference);
    const std::vector<Shown> shown = shownModels(models, &reference, options);

    const size_t bins = reference.Rd.size();
    Series zero{.label = reference.label, .style = SeriesStyle::steps, .x = reference.edges_mm};
    size_t usable = 0;
    for (size_t i = 0; i < bins; ++i) {
        const double mean = pick(reference.Rd[i], options.channel);
        const double error = pickError(reference.standard_error[i], options.channel);
        const bool known = isKnown(mean, error);
        usable += known;
        const double half = 100 * options.band_sigmas * error / mean;
        zero.y.push_back(known ? 0 : nan);
        zero.lower.push_back(known ? -half : nan);
        zero.upper.push_back(known ? half : nan);
    }
    if (usable == 0)
        throw inputError(
            fmt::format("no bin of reference '{}' is known to {:.0f} %", reference.label, 100 * largest_error),
            "walk more, or use wider bins");

    Figure figure;
    std::vector<double> sizes;
    for (const Shown& model : shown) {
        if (model.curve->bin_means.empty()) continue;
        Series series{
            .label = model.curve->label, .style = SeriesStyle::steps, .x = reference.edges_mm, .color = model.color};
        for (size_t i = 0; i < bins; ++i) {
            const double mean = pick(reference.Rd[i], options.channel);
            const bool known = !std::isnan(zero.y[i]);
            series.y.push_back(known ? 100 * (pick(model.curve->bin_means[i], options.channel) - mean) / mean : nan);
            if (std::isfinite(series.y.back())) sizes.push_back(std::abs(series.y.back()));
        }
        figure.series.push_back(std::move(series));
    }
    if (sizes.empty()) throw inputError("no model has means over the reference's annuli to compare");

    // Nine tenths of the bins decide the view, within 100 %.
    const auto rank = sizes.begin() + static_cast<std::ptrdiff_t>(0.9 * static_cast<double>(sizes.size() - 1));
    std::nth_element(sizes.begin(), rank, sizes.end());
    double view = 100;
    for (const double candidate : {60.0, 40.0, 20.0, 10.0, 4.0, 2.0, 1.0})
        if (1.1 * *rank <= candidate) view = candidate;
    const auto outside = std::count_if(sizes.begin(), sizes.end(), [&](double size) { return size > view; });

    figure.title = titleText("Relative error of models", options, false);
    figure.x = radiusAxis(options);
    figure.y = {"(model − reference) / reference", "%", AxisScale::linear, -view, view};
    figure.series.push_back(std::move(zero));
    figure.caption = fmt::format("Means over the reference's annuli; band: ±{} of the reference.", bandText(options));
    if (usable < bins)
        figure.caption +=
            fmt::format(" {} of {} annuli are left out: the reference's own standard error exceeds {:.0f} %.",
                        bins - usable, bins, 100 * largest_error);
    if (outside > 0) figure.caption += fmt::format(" {} of {} values lie beyond the frame.", outside, sizes.size());
    if (figure.x.scale == AxisScale::logarithmic) chooseFirstRadius(figure);
    return figure;
}

}  // namespace searchlight
