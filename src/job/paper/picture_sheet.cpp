#include "job/paper/picture_sheet.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "io/image_file.h"
#include "validate/image_error.h"

namespace searchlight {

namespace {

std::array<double, 3> channelsOf(const Rgba& pixel) {
    return {static_cast<double>(pixel.r), static_cast<double>(pixel.g), static_cast<double>(pixel.b)};
}

double meanOf(const Image& image) {
    double sum = 0, count = 0;
    for (const Rgba& pixel : image.pixels) {
        if (!(pixel.a > 0)) continue;
        for (const double value : channelsOf(pixel)) sum += value;
        count += 3;
    }
    return sum / count;
}

// Mean square of a picture of standard errors, over the pixels that `cover` covers.
double meanSquare(const Image& error, const Image& cover) {
    if (error.empty()) return 0;
    double sum = 0, count = 0;
    for (std::size_t i = 0; i < error.pixels.size(); ++i) {
        if (!(cover.pixels[i].a > 0)) continue;
        for (const double value : channelsOf(error.pixels[i])) sum += value * value;
        count += 3;
    }
    return sum / count;
}

SheetCell cellOf(Image image, const Image& cover, std::string note) {
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        Rgba& pixel = image.pixels[i];
        const float covered = cover.pixels[i].a;
        pixel = {covered * pixel.r, covered * pixel.g, covered * pixel.b, covered};
    }
    return {imageBytes("sheet.png", {image, {}, {}}), std::move(note)};
}

}  // namespace

NoisyError noisyError(const NoisyImage& image, const NoisyImage& reference, double exposure, int threads) {
    const ImageError plain = compareImages(image.mean, reference.mean, {.exposure = exposure, .threads = threads});
    const double noise = meanSquare(image.error, reference.mean) + meanSquare(reference.error, reference.mean);
    NoisyError error;
    error.rmse = plain.relative_rmse;
    error.noise = std::sqrt(noise) / meanOf(reference.mean);
    error.bias = std::sqrt(std::max(0.0, error.rmse * error.rmse - error.noise * error.noise));
    error.mean = plain.mean_difference;
    error.ssim = plain.ssim;
    return error;
}

Json noisyErrorJson(const NoisyError& error) {
    return {{"relative_rmse", error.rmse},
            {"relative_noise", error.noise},
            {"relative_rmse_without_noise", error.bias},
            {"mean_difference", error.mean},
            {"ssim", error.ssim}};
}

void appendRight(Image& left, const Image& right) {
    if (left.empty()) {
        left = right;
        return;
    }
    assert(left.height == right.height);
    Image both(left.width + right.width, left.height);
    for (int y = 0; y < both.height; ++y)
        for (int x = 0; x < both.width; ++x)
            both.at(x, y) = x < left.width ? left.at(x, y) : right.at(x - left.width, y);
    left = std::move(both);
}

void appendRight(NoisyImage& left, const NoisyImage& right) {
    appendRight(left.mean, right.mean);
    appendRight(left.error, right.error);
}

SheetCell pictureCell(const Image& image, double exposure, std::string note) {
    return {imageBytes("sheet.png", {image, {}, {}}, {.exposure = exposure}), std::move(note)};
}

SheetCell differenceCell(const Image& image, const Image& reference, double full_scale, std::string note) {
    return cellOf(differenceImage(image, reference, {.full_scale = full_scale, .is_signed = true}), reference,
                  std::move(note));
}

SheetCell squareCell(const Image& image, const Image& reference, double full_scale, std::string note) {
    const double full = std::pow(full_scale * meanOf(reference), 2);
    Image squares(image.width, image.height);
    const auto square = [&](float a, float b) {
        return static_cast<float>(std::min(1.0, std::pow(static_cast<double>(a - b), 2) / full));
    };
    for (std::size_t i = 0; i < squares.pixels.size(); ++i) {
        const Rgba &a = image.pixels[i], &b = reference.pixels[i];
        squares.pixels[i] = {square(a.r, b.r), square(a.g, b.g), square(a.b, b.b), 1};
    }
    return cellOf(std::move(squares), reference, std::move(note));
}

}  // namespace searchlight
