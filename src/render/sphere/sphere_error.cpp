#include "render/sphere/sphere_error.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/image.h"

namespace searchlight {

namespace {

double channelOf(const Rgba& pixel, std::size_t channel) {
    return static_cast<double>(channel == 0 ? pixel.r : channel == 1 ? pixel.g : pixel.b);
}

// How much the exitance of each cell counts in the sum over all pixels.
std::vector<double> cellWeights(const CellView& view, std::size_t cells) {
    std::vector<double> weights(cells, 0.0);
    for (const CellSample& sample : view.samples)
        weights[sample.cell] += static_cast<double>(sample.coverage) * static_cast<double>(sample.exit);
    return weights;
}

}  // namespace

CellValues cellValues(const std::array<std::vector<double>, Rgb::channels>& values) {
    return {values[0], values[1], values[2]};
}

double suitedExposure(const Image& image) {
    constexpr double white = 0.8;
    std::vector<float> brightest;
    for (const Rgba& pixel : image.pixels)
        if (pixel.a > 0) brightest.push_back(std::max({pixel.r, pixel.g, pixel.b}));
    if (brightest.empty()) return 0;
    const auto place = brightest.begin() + static_cast<std::ptrdiff_t>(brightest.size() * 98 / 100);
    std::ranges::nth_element(brightest, place);
    return *place > 0 ? std::log2(white / static_cast<double>(*place)) : 0;
}

std::array<SphereError, Rgb::channels> sphereErrors(const CellView& view, const SphereExitance& model,
                                                    const SphereExitance& reference) {
    std::array<SphereError, Rgb::channels> errors;
    const Image ours = pictureOfRadiance(view, cellValues(model.mean));
    const Image theirs = pictureOfRadiance(view, cellValues(reference.mean));
    const Image our_noise = pictureOfError(view, cellValues(model.standard_error));
    const Image their_noise = pictureOfError(view, cellValues(reference.standard_error));
    for (std::size_t c = 0; c < errors.size(); ++c) {
        SphereError& error = errors[c];
        if (model.mean[c].empty() || reference.mean[c].empty()) {
            error.model = error.reference = error.rmse = error.noise = error.bias =
                std::numeric_limits<double>::quiet_NaN();
            error.mean_difference = {error.model, error.model, 0};
            continue;
        }
        double pixels = 0, square = 0, noise = 0;
        for (std::size_t i = 0; i < ours.pixels.size(); ++i) {
            if (!(theirs.pixels[i].a > 0)) continue;
            ++pixels;
            const double a = channelOf(ours.pixels[i], c), b = channelOf(theirs.pixels[i], c);
            error.model += a;
            error.reference += b;
            square += (a - b) * (a - b);
            noise += std::pow(channelOf(our_noise.pixels[i], c), 2) + std::pow(channelOf(their_noise.pixels[i], c), 2);
        }
        error.model /= pixels;
        error.reference /= pixels;
        error.rmse = std::sqrt(square / pixels) / error.reference;
        error.noise = std::sqrt(noise / pixels) / error.reference;
        error.bias = std::sqrt(std::max(0.0, error.rmse * error.rmse - error.noise * error.noise));
        // Pixels share cells, so the noise of the mean is that of the cells.
        const std::vector<double> weights = cellWeights(view, model.mean[c].size());
        double variance = 0;
        const double ratio = error.model / error.reference;
        for (std::size_t cell = 0; cell < weights.size(); ++cell) {
            if (weights[cell] == 0) continue;
            variance += std::pow(weights[cell] * model.standard_error[c][cell], 2) +
                        std::pow(weights[cell] * ratio * reference.standard_error[c][cell], 2);
        }
        error.mean_difference = {ratio - 1, std::sqrt(variance) / pixels / error.reference, 0};
    }
    return errors;
}

}  // namespace searchlight
