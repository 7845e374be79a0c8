#include "kernel/judge.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kernel/preintegrated.h"

namespace searchlight {

namespace {

double sideOf(const GroundTruth& truth) {
    std::vector<double> radii;
    for (int c = 0; c < Rgb::channels; ++c)
        if (truth.scatters(c)) radii.push_back(truth.radiusOf(0.5, c));
    if (radii.empty()) return 1;
    std::ranges::sort(radii);
    return 16 * radii[radii.size() / 2];
}

}  // namespace

Judge::Judge(const GroundTruth& truth, const JudgeOptions& options)
    : cells_(cellKernel(truth, options.grid.cell_mm > 0 ? options.grid : gridOf(truth))),
      pixel_mm_((options.side_mm > 0 ? options.side_mm : sideOf(truth)) / options.size),
      spectrum_(lineSpread(truth), std::numbers::pi / (options.size * pixel_mm_), 1.5 * std::numbers::pi / pixel_mm_) {
    for (const Signal& signal : signals()) {
        inputs_.push_back(signal.make(options.size));
        exact_.push_back(exactFilter(inputs_.back(), spectrum_, pixel_mm_));
    }
}

Image Judge::filter(const Image& input, const Taps& taps, int frames) const {
    return tapsFilter(input, taps, {.pixel_mm = pixel_mm_, .turned = taps.turned, .frames = frames});
}

std::vector<Rgb> Judge::imageRms(const Taps& taps, int frames) const {
    std::vector<Rgb> errors;
    for (std::size_t i = 0; i < inputs_.size(); ++i) {
        const Image image = filter(inputs_[i], taps, frames);
        Rgb sum;
        for (std::size_t k = 0; k < image.pixels.size(); ++k) {
            const Rgba &a = image.pixels[k], &b = exact_[i].pixels[k];
            const Rgb difference{a.r - b.r, a.g - b.g, a.b - b.b};
            sum = sum + difference * difference;
        }
        sum = (1.0 / static_cast<double>(image.pixels.size())) * sum;
        errors.push_back({std::sqrt(sum.r), std::sqrt(sum.g), std::sqrt(sum.b)});
    }
    return errors;
}

double Judge::bestWidth(const Taps& taps) const {
    const double side = static_cast<double>(inputs_.front().width) * pixel_mm_;
    const auto error = [&](double width) {
        double sum = 0;
        // Edges in three directions: power over the frequency's logarithm falls as 1 / omega.
        for (double omega = std::numbers::pi / side; omega < std::numbers::pi / pixel_mm_; omega *= std::exp2(0.25))
            for (const double angle : {0.13, 0.39, 0.65}) {
                const Rgb difference =
                    tapsTransform(taps, omega * std::cos(angle), omega * std::sin(angle), width) - spectrum_(omega);
                for (int c = 0; c < Rgb::channels; ++c) sum += difference[c] * difference[c] / omega;
            }
        return sum;
    };
    double best = 1, least = error(1);
    const auto look = [&](double from, double ratio, int count) {
        for (int i = 0; i < count; ++i) {
            const double width = from * std::pow(ratio, i), value = error(width);
            if (value >= least) continue;
            least = value;
            best = width;
        }
    };
    look(1e-3, 1.15, 100);
    look(best / 1.15, 1.01, 29);
    return best;
}

double Judge::overall(const std::vector<Rgb>& image_rms) {
    double sum = 0;
    for (const Rgb& rms : image_rms)
        for (int c = 0; c < Rgb::channels; ++c) sum += rms[c] * rms[c];
    return std::sqrt(sum / (3 * static_cast<double>(image_rms.size())));
}

Rgb Judge::kernelRms(const SeparableKernel& kernel) const {
    return searchlight::kernelRms(cellKernel(kernel, cells_.edges), cells_);
}

}  // namespace searchlight
