#include "kernel/filter.h"

#include <array>
#include <cassert>
#include <cmath>
#include <complex>
#include <numbers>

#include "kernel/fourier.h"

namespace searchlight {

namespace {

float& channelOf(Rgba& pixel, int c) { return c == 0 ? pixel.r : c == 1 ? pixel.g : pixel.b; }
float channelOf(const Rgba& pixel, int c) { return c == 0 ? pixel.r : c == 1 ? pixel.g : pixel.b; }

}  // namespace

Image exactFilter(const Image& image, const RadialSpectrum& truth, double pixel_mm) {
    assert(image.width == image.height && image.width % 2 == 0);
    const int n = image.width;
    const auto size = static_cast<std::size_t>(n);
    const double step = 2 * std::numbers::pi / (n * pixel_mm);
    // Radial, and even along both axes: an octant is enough.
    std::vector<Rgb> factor((size / 2 + 1) * (size / 2 + 1));
    for (std::size_t j = 0; j <= size / 2; ++j)
        for (std::size_t i = 0; i <= j; ++i)
            factor[j * (size / 2 + 1) + i] = factor[i * (size / 2 + 1) + j] =
                truth(step * std::hypot(static_cast<double>(i), static_cast<double>(j)));
    Image result(n, n, {0, 0, 0, 1});
    std::vector<std::complex<double>> values(size * size);
    for (int c = 0; c < Rgb::channels; ++c) {
        for (std::size_t i = 0; i < values.size(); ++i) values[i] = channelOf(image.pixels[i], c);
        fourier(values, size, false);
        for (std::size_t j = 0; j < size; ++j)
            for (std::size_t i = 0; i < size; ++i)
                values[j * size + i] *= factor[std::min(j, size - j) * (size / 2 + 1) + std::min(i, size - i)][c];
        fourier(values, size, true);
        for (std::size_t i = 0; i < values.size(); ++i)
            channelOf(result.pixels[i], c) = static_cast<float>(values[i].real());
    }
    return result;
}

namespace {

// A sample of a pass, in pixels.
struct Sample {
    int dx = 0, dy = 0;
    Rgbf weight;
};

// The bilinear samples of taps along a direction; the samples of one pixel are added up.
std::vector<Sample> samplesAlong(const TapTerm& term, double x, double y, double per_pixel) {
    std::vector<Sample> samples;
    const auto add = [&](double dx, double dy, Rgb weight) {
        const double left = std::floor(dx), top = std::floor(dy), s = dx - left, t = dy - top;
        for (int j = 0; j < 2; ++j)
            for (int i = 0; i < 2; ++i) {
                const double part = (i == 0 ? 1 - s : s) * (j == 0 ? 1 - t : t);
                if (part < 1e-9) continue;
                const int px = static_cast<int>(left) + i, py = static_cast<int>(top) + j;
                Sample* known = nullptr;
                for (Sample& sample : samples)
                    if (sample.dx == px && sample.dy == py) known = &sample;
                if (!known) known = &samples.emplace_back(Sample{.dx = px, .dy = py});
                known->weight = toFloat(toDouble(known->weight) + part * weight);
            }
    };
    for (std::size_t i = 0; i < term.offsets_mm.size(); ++i) {
        const double at = term.offsets_mm[i] * per_pixel;
        add(at * x, at * y, term.weights[i]);
    }
    add(0, 0, term.delta);
    return samples;
}

int wrapped(int at, int n) {
    const int rest = at % n;
    return rest < 0 ? rest + n : rest;
}

// Angles that are told apart: at an offset of 30 pixels neighbours are half a pixel from each other.
constexpr int turns = 96;

Image pass(const Image& image, const TapTerm& term, bool second, const FilterOptions& options, int frame) {
    const int n = image.width, patterns = options.turned ? turns : 1;
    Image result(n, image.height, {0, 0, 0, 1});
    std::vector<std::vector<Sample>> samples;
    for (int k = 0; k < patterns; ++k) {
        const double angle =
            (term.angle_deg / 180 + (second ? 0.5 : 0) + static_cast<double>(k) / patterns) * std::numbers::pi;
        const double x = std::abs(std::cos(angle)) < 1e-12 ? 0 : std::cos(angle);
        const double y = std::abs(std::sin(angle)) < 1e-12 ? 0 : std::sin(angle);
        samples.push_back(samplesAlong(term, x, y, options.width / options.pixel_mm));
    }
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < n; ++x) {
            const int turn =
                options.turned ? static_cast<int>(turns / std::numbers::pi * turnOfPixel(x, y, frame, second)) : 0;
            Rgbf sum;
            for (const Sample& sample : samples[static_cast<std::size_t>(turn)]) {
                const Rgba& pixel = image.pixels[static_cast<std::size_t>(wrapped(y + sample.dy, image.height) * n +
                                                                          wrapped(x + sample.dx, n))];
                sum.r += sample.weight.r * pixel.r;
                sum.g += sample.weight.g * pixel.g;
                sum.b += sample.weight.b * pixel.b;
            }
            result.pixels[static_cast<std::size_t>(y * n + x)] = {sum.r, sum.g, sum.b, 1};
        }
    return result;
}

}  // namespace

double turnOfPixel(double x, double y, int frame, bool second) {
    // Second passes see another part of the pattern. From frame to frame both angles go on by the steps of the sequence
    // that fills a square most evenly [Roberts2018], so that few frames meet all pairs of angles.
    const double shift = second ? 61.470618 : 0, step = second ? 0.5698402909980532 : 0.7548776662466927;
    const double inner = 0.06711056 * (x + shift) + 0.00583715 * (y + shift);
    const double outer = 52.9829189 * (inner - std::floor(inner));
    const double turn = outer + step * frame;
    return std::numbers::pi * (turn - std::floor(turn));
}

Image tapsFilter(const Image& image, const Taps& taps, const FilterOptions& options) {
    Image sum(image.width, image.height, {0, 0, 0, 1});
    const int frames = options.turned ? options.frames : 1;
    for (const TapTerm& term : taps.terms)
        for (int frame = 0; frame < frames; ++frame) {
            const Image blurred = pass(pass(image, term, false, options, frame), term, true, options, frame);
            for (std::size_t i = 0; i < sum.pixels.size(); ++i)
                for (int c = 0; c < Rgb::channels; ++c)
                    channelOf(sum.pixels[i], c) +=
                        static_cast<float>(term.scale[c] / frames) * channelOf(blurred.pixels[i], c);
        }
    return sum;
}

}  // namespace searchlight
