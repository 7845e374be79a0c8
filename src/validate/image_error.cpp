#include "validate/image_error.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/error.h"
#include "base/srgb.h"
#include "validate/flip.h"
#include "validate/ssim.h"

namespace searchlight {

namespace {

void checkSizes(const Image& image, const Image& reference) {
    if (image.width != reference.width || image.height != reference.height)
        throw usageError(fmt::format("the picture is {} x {} pixels, its reference {} x {}", image.width, image.height,
                                     reference.width, reference.height),
                         "both have to be of one size");
}

bool isFinite(const Rgba& pixel) { return std::isfinite(pixel.r) && std::isfinite(pixel.g) && std::isfinite(pixel.b); }

// Of R, G and B over what the reference covers. Throws for values that no error can be stated of.
double meanOf(const Image& image, const Image& reference) {
    double sum = 0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < reference.pixels.size(); ++i) {
        const Rgba& r = reference.pixels[i];
        for (const Image* picture : {&image, &reference}) {
            if (isFinite(picture->pixels[i])) continue;
            const int x = static_cast<int>(i) % image.width, y = static_cast<int>(i) / image.width;
            throw inputError(fmt::format("{} has a value at ({}, {}) that is infinite or not a number",
                                         picture == &image ? "the picture" : "the reference", x, y));
        }
        if (r.a <= 0) continue;
        sum += static_cast<double>(r.r) + r.g + r.b;
        count += 3;
    }
    if (count == 0) throw inputError("the reference covers no pixel", "expected alpha above 0 somewhere");
    if (sum <= 0) throw inputError("the reference is black where it covers", "errors are relative to its mean");
    return sum / static_cast<double>(count);
}

double meanWhereCovered(const PixelPlane& plane, const Image& reference) {
    double sum = 0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < plane.values.size(); ++i) {
        if (reference.pixels[i].a <= 0) continue;
        sum += plane.values[i];
        ++count;
    }
    return sum / static_cast<double>(count);
}

Rgb difference(const Rgba& a, const Rgba& b) {
    return {static_cast<double>(a.r) - b.r, static_cast<double>(a.g) - b.g, static_cast<double>(a.b) - b.b};
}

Rgba fromCodes(const Rgb& code) {
    const auto linear = [](double value) { return static_cast<float>(linearFromSrgb(std::clamp(value, 0., 1.))); };
    return {linear(code.r), linear(code.g), linear(code.b), 1};
}

// [Green2011] with its defaults: a helix about the grey diagonal, from black at 0 to white at 1.
Rgb cubehelix(double t) {
    const double angle = 2 * std::numbers::pi * (0.5 / 3 + 1 - 1.5 * t), width = t * (1 - t) / 2;
    const double c = std::cos(angle), s = std::sin(angle);
    return {t + width * (-0.14861 * c + 1.78277 * s), t + width * (-0.29227 * c - 0.90649 * s),
            t + width * 1.97294 * c};
}

// From black to pale blue (-1) or to pale orange (1), by colours of the same lightness on both sides.
Rgb diverging(double t) {
    // CIELAB lightness 0, 50 and 80.
    static constexpr std::array<std::array<Rgb, 3>, 2> ends{
        {{{{0, 0, 0}, {0.098, 0.478, 0.769}, {0.541, 0.808, 0.976}}},
         {{{0, 0, 0}, {0.733, 0.361, 0.0}, {1, 0.722, 0.376}}}}};
    const std::array<Rgb, 3>& side = ends[t < 0 ? 0 : 1];
    const double lightness = std::abs(t) * 80;
    return lightness < 50 ? lightness / 50 * side[1] : side[1] + (lightness - 50) / 30 * (side[2] - side[1]);
}

}  // namespace

ImageError compareImages(const Image& image, const Image& reference, const ImageErrorOptions& options) {
    checkSizes(image, reference);
    const double mean = meanOf(image, reference);
    ImageError error;
    double squares = 0, signed_sum = 0;
    for (std::size_t i = 0; i < reference.pixels.size(); ++i) {
        if (reference.pixels[i].a <= 0) continue;
        ++error.pixels;
        const Rgb d = difference(image.pixels[i], reference.pixels[i]);
        for (int c = 0; c < Rgb::channels; ++c) {
            squares += d[c] * d[c];
            signed_sum += d[c];
            error.largest = std::max(error.largest, std::abs(d[c]));
        }
    }
    const double values = 3 * static_cast<double>(error.pixels);
    error.rmse = std::sqrt(squares / values);
    error.relative_rmse = error.rmse / mean;
    error.mean_difference = signed_sum / values / mean;
    if (!options.perceptual) return error;
    const double factor = std::exp2(options.exposure);
    error.ssim = meanWhereCovered(ssimMap(image, reference, factor, options.white, options.threads), reference);
    error.flip =
        meanWhereCovered(flipMap(image, reference, factor, options.pixels_per_degree, options.threads), reference);
    return error;
}

Image differenceImage(const Image& image, const Image& reference, const DifferenceOptions& options) {
    checkSizes(image, reference);
    const double full_scale = options.full_scale * meanOf(image, reference);
    Image colours(image.width, image.height);
    for (std::size_t i = 0; i < colours.pixels.size(); ++i) {
        const Rgb d = difference(image.pixels[i], reference.pixels[i]);
        if (options.is_signed) {
            colours.pixels[i] = fromCodes(diverging(std::clamp(luminance(d) / full_scale, -1., 1.)));
        } else {
            const double largest = std::max({std::abs(d.r), std::abs(d.g), std::abs(d.b)});
            colours.pixels[i] = fromCodes(cubehelix(std::min(largest / full_scale, 1.)));
        }
    }
    return colours;
}

}  // namespace searchlight
