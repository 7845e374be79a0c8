#include "transport/mesh/cell_picture.h"

#include <cassert>
#include <cmath>
#include <map>
#include <numbers>

#include "model/physics.h"

namespace searchlight {

namespace {

// Calls visit(pixel, samples) for the samples of each pixel.
template <class Visit>
void forEachPixel(const CellView& view, const Visit& visit) {
    const std::span<const CellSample> samples(view.samples);
    for (std::size_t first = 0, end = 0; first < samples.size(); first = end) {
        while (end < samples.size() && samples[end].pixel == samples[first].pixel) ++end;
        visit(samples[first].pixel, samples.subspan(first, end - first));
    }
}

float& channelOf(Rgba& pixel, std::size_t channel) { return channel == 0 ? pixel.r : channel == 1 ? pixel.g : pixel.b; }

Image emptyImage(const CellView& view) { return {view.width, view.height}; }

template <class Weight>
Image weighted(const CellView& view, const CellValues& values, const Weight& weight) {
    Image image = emptyImage(view);
    forEachPixel(view, [&](std::uint32_t at, std::span<const CellSample> samples) {
        Rgba& pixel = image.pixels[at];
        for (const CellSample& sample : samples) {
            pixel.a += sample.coverage;
            for (std::size_t c = 0; c < values.size(); ++c)
                if (!values[c].empty())
                    channelOf(pixel, c) += static_cast<float>(weight(sample) * values[c][sample.cell]);
        }
    });
    return image;
}

}  // namespace

Image pictureOfRadiance(const CellView& view, const CellValues& exitance) {
    return weighted(view, exitance, [](const CellSample& s) { return static_cast<double>(s.coverage) * s.exit; });
}

Image pictureOfExitance(const CellView& view, const CellValues& exitance) {
    return weighted(view, exitance, [](const CellSample& s) { return static_cast<double>(s.coverage); });
}

Image pictureOfError(const CellView& view, const CellValues& standard_error) {
    Image image = emptyImage(view);
    std::map<std::uint32_t, double> weights;  // of the pixel's cells
    forEachPixel(view, [&](std::uint32_t at, std::span<const CellSample> samples) {
        weights.clear();
        Rgba& pixel = image.pixels[at];
        for (const CellSample& sample : samples) {
            weights[sample.cell] += static_cast<double>(sample.coverage) * sample.exit;
            pixel.a += sample.coverage;
        }
        for (std::size_t c = 0; c < standard_error.size(); ++c) {
            if (standard_error[c].empty()) continue;
            double variance = 0;
            for (const auto& [cell, weight] : weights) {
                const double error = weight * standard_error[c][cell];
                variance += error * error;
            }
            channelOf(pixel, c) = static_cast<float>(std::sqrt(variance));
        }
    });
    return image;
}

Image pictureOfCells(const CellView& view) {
    Image image = emptyImage(view);
    forEachPixel(view, [&](std::uint32_t at, std::span<const CellSample> samples) {
        image.pixels[at].r = static_cast<float>(samples[samples.size() / 2].cell + 1);
        for (const CellSample& sample : samples) image.pixels[at].a += sample.coverage;
    });
    return image;
}

double exitFactor(double eta, double cosine) {
    using Fresnel = Physics<double>;
    const double normalizer = std::numbers::pi * (1 - 2 * Fresnel::fresnelMoment(1, 1 / eta));
    return (1 - Fresnel::fresnelReflectance(cosine, 1 / eta)) / normalizer;
}

}  // namespace searchlight
