#include "plot/kernel_plots.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "base/error.h"

namespace searchlight {

namespace {

constexpr const char* channel_names[] = {"red", "green", "blue"};

void checkChannel(int channel) {
    if (channel < 0 || channel >= Rgb::channels) throw inputError(fmt::format("there is no channel {}", channel));
}

float valueOf(const Rgba& pixel, int channel) { return channel == 0 ? pixel.r : channel == 1 ? pixel.g : pixel.b; }

double luminanceOf(const Rgba& pixel) { return luminance({pixel.r, pixel.g, pixel.b}); }

// Every pixel as a cell, in mm.
FalseColor mapOf(const Judge& judge, const std::function<double(std::size_t)>& value) {
    const int n = judge.inputs().front().width;
    FalseColor map;
    for (int i = 0; i <= n; ++i) map.x_edges.push_back(i * judge.pixel());
    map.y_edges = map.x_edges;
    for (int y = n - 1; y >= 0; --y)
        for (int x = 0; x < n; ++x) map.values.push_back(value(static_cast<std::size_t>(y * n + x)));
    return map;
}

Axis lengthAxis() { return {.label = "x", .unit = "mm"}; }

}  // namespace

Figure kernelSliceFigure(const GroundTruth& truth, std::span<const KernelCurve> kernels, int channel,
                         const std::string& title) {
    checkChannel(channel);
    Figure figure{.title = title,
                  .caption = fmt::format("Density of the normalised kernels, {} channel; deltas are not drawn, nor is "
                                         "what is negative.",
                                         channel_names[channel])};
    figure.columns = 2;
    const double end = truth.radiusOf(0.99, channel), near = truth.radiusOf(0.02, channel);
    for (const bool diagonal : {false, true}) {
        Figure panel{.title = diagonal ? "Along the diagonal" : "Along the axis"};
        panel.x = {"Distance from the middle", "mm", AxisScale::square_root, 0, end};
        panel.y = {"Kernel", "1/mm²", AxisScale::logarithmic, 0.3 * truth(end)[channel], 3 * truth(near)[channel]};
        Series exact{.label = "ground truth"};
        constexpr int count = 400;
        for (int i = 0; i <= count; ++i) {
            const double t = static_cast<double>(i) / count;
            exact.x.push_back(near * 0.2 + (end - 0.2 * near) * t * t);
        }
        for (const double r : exact.x) exact.y.push_back(truth(r)[channel]);
        int color = 0;
        for (const KernelCurve& curve : kernels) {
            Series line{.label = curve.label, .x = exact.x, .color = color++};
            for (const double r : exact.x) {
                const double x = diagonal ? r * std::sqrt(0.5) : r, y = diagonal ? x : 0;
                const double value = curve.kernel(x, y)[channel];
                line.y.push_back(value > 0 ? value : std::nan(""));
            }
            panel.series.push_back(std::move(line));
        }
        panel.series.push_back(std::move(exact));
        figure.panels.push_back(std::move(panel));
    }
    return figure;
}

Figure kernelEdgeFigure(const Judge& judge, std::span<const KernelCurve> kernels, int channel,
                        const std::string& title) {
    checkChannel(channel);
    const std::vector<Image>& exact = judge.exact();
    const int n = exact.front().width, row = n / 2, first = 0, last = n / 2;
    Figure figure{.title = title,
                  .caption = fmt::format("An upright edge filtered with the taps, {} channel. Irradiance is 0 on the "
                                         "left and 1 on the right of the middle.",
                                         channel_names[channel])};
    figure.columns = 2;
    Figure response{.title = "Filtered edge"}, difference{.title = "Difference from the ground truth"};
    response.x = difference.x = {.label = "Distance from the edge", .unit = "mm"};
    response.y.label = "Filtered light";
    difference.y.label = "Difference";
    std::vector<double> x;
    for (int i = first; i < last; ++i) x.push_back((i + 0.5 - 0.25 * n) * judge.pixel());
    int color = 0;
    for (const KernelCurve& curve : kernels) {
        const Image image = judge.filter(judge.inputs().front(), curve.taps);
        Series line{.label = curve.label, .x = x, .color = color++}, off = line;
        for (int i = first; i < last; ++i) {
            line.y.push_back(valueOf(image.at(i, row), channel));
            off.y.push_back(line.y.back() - valueOf(exact.front().at(i, row), channel));
        }
        response.series.push_back(std::move(line));
        difference.series.push_back(std::move(off));
    }
    Series truth{.label = "ground truth", .x = x};
    for (int i = first; i < last; ++i) truth.y.push_back(valueOf(exact.front().at(i, row), channel));
    response.series.push_back(std::move(truth));
    figure.panels = {std::move(response), std::move(difference)};
    return figure;
}

Figure kernelPictureFigure(const Judge& judge, std::size_t signal, const std::string& title) {
    Figure figure{.title = title,
                  .caption = "Luminance of the light that falls in, and of what the ground truth makes of it."};
    figure.columns = 2;
    figure.color = {.label = "Luminance", .max = 1};
    for (const bool after : {false, true}) {
        const Image& image = (after ? judge.exact() : judge.inputs())[signal];
        Figure panel{.title = after ? "After" : "Before", .x = lengthAxis(), .y = {.label = "y", .unit = "mm"}};
        panel.map = mapOf(judge, [&](std::size_t i) { return std::clamp(luminanceOf(image.pixels[i]), 0.0, 1.0); });
        figure.panels.push_back(std::move(panel));
    }
    return figure;
}

Figure kernelDifferenceFigure(const Judge& judge, std::span<const KernelCurve> kernels, std::size_t signal,
                              const std::string& title) {
    Figure figure{.title = title,
                  .caption =
                      "Absolute difference of luminance from the ground truth, all on one scale; what is above "
                      "its end has the colour of the end."};
    figure.columns = std::min<int>(4, static_cast<int>(kernels.size()));
    const Image& exact = judge.exact()[signal];
    std::vector<double> largest;
    for (const KernelCurve& curve : kernels) {
        const Image image = judge.filter(judge.inputs()[signal], curve.taps);
        Figure panel{.title = curve.label, .x = lengthAxis(), .y = {.label = "y", .unit = "mm"}};
        panel.map = mapOf(judge, [&](std::size_t i) {
            return std::abs(luminanceOf(image.pixels[i]) - luminanceOf(exact.pixels[i]));
        });
        largest.push_back(*std::ranges::max_element(panel.map->values));
        figure.panels.push_back(std::move(panel));
    }
    // The scale ends where the middle one of the kernels does: the worst would hide all others.
    std::ranges::sort(largest);
    const double end = largest.empty() ? 1 : std::max(1e-6, largest[largest.size() / 2]);
    figure.color = {.label = "|Difference|", .max = end};
    for (Figure& panel : figure.panels)
        for (double& value : panel.map->values) value = std::min(value, end);
    return figure;
}

}  // namespace searchlight
