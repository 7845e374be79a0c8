// Pictures that no kernel was made by and that the program does not judge by, and ground truths of real materials.
#pragma once

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string_view>
#include <vector>

#include "base/image.h"
#include "kernel/filter.h"
#include "kernel/judge.h"
#include "kernel/methods.h"
#include "model/plane.h"
#include "scene/materials.h"

namespace searchlight::test {

inline GroundTruth truthOf(const Medium& medium, std::string_view id) {
    const Model model = loadModel(id);
    const auto evaluator = makeNativeEvaluator(model);
    evaluator->set(medium, {});
    Tabulation table = tabulate(*evaluator, model, medium);
    return GroundTruth(std::move(table.profile), table.tail);
}

/// Six of them, repeating beyond their sides: level bands, a ring, a slanted chessboard, blocks of noise, a star and
/// slanted stripes that fade.
inline std::vector<Image> heldOut(int size) {
    constexpr double pi = 3.14159265358979323846;
    const auto parity = [](double a, double b) {
        return static_cast<double>((static_cast<int>(std::floor(a)) + static_cast<int>(std::floor(b))) & 1);
    };
    const auto block = [](double u, double v) {
        unsigned hash = (static_cast<unsigned>(11 * u) * 57u + static_cast<unsigned>(11 * v) + 1u) * 2654435761u;
        hash ^= hash >> 15;
        return static_cast<double>((hash * 2246822519u) >> 24) / 255;
    };
    const auto value = [&](int picture, double u, double v) -> double {
        const double r = std::hypot(u - 0.5, v - 0.5), phi = std::atan2(v - 0.5, u - 0.5);
        switch (picture) {
            case 0: return v > 0.1 && v < 0.35 ? 1 : v > 0.6 && v < 0.7 ? 0.6 : 0;
            case 1: return r > 0.17 && r < 0.33 ? 1 : 0.1;
            case 2: return parity(3 * u + v, 3 * v - u);
            case 3: return block(u, v);
            case 4: return r < 0.3 + 0.15 * std::cos(7 * phi) ? 0.9 : 0;
            default: return parity(2 * u + 3 * v, 0) * (0.6 + 0.4 * std::cos(2 * pi * u));
        }
    };
    std::vector<Image> pictures;
    for (int picture = 0; picture < 6; ++picture) {
        Image image(size, size, {0, 0, 0, 1});
        for (int y = 0; y < size; ++y)
            for (int x = 0; x < size; ++x) {
                double sum = 0;
                for (int i = 0; i < 16; ++i)
                    sum += value(picture, (x + (i % 4 + 0.5) / 4) / size, (y + (i / 4 + 0.5) / 4) / size) / 16;
                const auto mean = static_cast<float>(sum);
                image.at(x, y) = {mean, mean, mean, 1};
            }
        pictures.push_back(std::move(image));
    }
    return pictures;
}

/// Errors of kernels on those pictures.
class HeldOut {
public:
    /// Pictures of 64 x 64 pixels, 16 half-energy radii wide.
    explicit HeldOut(const GroundTruth& truth) : truth_(truth), judge_(truth, {.size = 64}), inputs_(heldOut(64)) {
        for (const Image& input : inputs_) exact_.push_back(exactFilter(input, judge_.spectrum(), judge_.pixel()));
    }

    /// RMS over the channels, picture by picture.
    std::vector<double> errors(const MethodOptions& options) const {
        const Taps taps = makeKernel(truth_, judge_.cells(), options).taps;
        std::vector<double> list;
        for (std::size_t i = 0; i < inputs_.size(); ++i) {
            const Image found = judge_.filter(inputs_[i], taps);
            double sum = 0;
            for (std::size_t k = 0; k < found.pixels.size(); ++k) {
                const Rgba &a = found.pixels[k], &b = exact_[i].pixels[k];
                sum += std::pow(a.r - b.r, 2) + std::pow(a.g - b.g, 2) + std::pow(a.b - b.b, 2);
            }
            list.push_back(std::sqrt(sum / (3.0 * static_cast<double>(found.pixels.size()))));
        }
        return list;
    }

private:
    const GroundTruth& truth_;
    Judge judge_;
    std::vector<Image> inputs_, exact_;
};

/// What [Freude2014] compares at two passes and at four; Gaussians as it fits them, in kernel space.
inline std::vector<MethodOptions> thesisKernels(int passes) {
    constexpr GaussianMeasure any_mass = GaussianMeasure::kernel_space_any_mass;
    if (passes == 4)
        return {{.method = "svd", .rank = 2},
                {.method = "gaussians", .count = 2, .measure = any_mass},
                {.method = "gaussians", .count = 2, .measure = GaussianMeasure::kernel_space}};
    return {{},
            {.method = "svd"},
            {.method = "guided", .guided = {.k = 0}},
            {.method = "guided", .guided = {.k = 1}},
            {.method = "guided", .guided = {.k = 2}},
            {.method = "gaussians", .count = 1, .measure = any_mass},
            {.method = "gaussians", .count = 1, .measure = GaussianMeasure::kernel_space},
            {.method = "manual"},
            {.method = "skin"}};
}

/// What is best here: of two passes on axes that turn, over 8 frames.
inline MethodOptions bestKernel(int passes) {
    if (passes == 4) return {.method = "optimised", .rank = 2};
    return {.method = "turned"};
}

/// Errors of the best kernel over the smallest ones of the thesis' kernels: the largest over the pictures, below 1
/// where it is ahead on each of them; and that over all pictures.
struct Ratios {
    double worst = 0, overall = 0;
};

inline Ratios ratios(const HeldOut& pictures, int passes) {
    const auto squares = [](const std::vector<double>& errors) {
        return std::inner_product(errors.begin(), errors.end(), errors.begin(), 0.0);
    };
    const std::vector<double> best = pictures.errors(bestKernel(passes));
    Ratios found;
    for (const MethodOptions& options : thesisKernels(passes)) {
        const std::vector<double> other = pictures.errors(options);
        for (std::size_t i = 0; i < best.size(); ++i) found.worst = std::max(found.worst, best[i] / other[i]);
        found.overall = std::max(found.overall, std::sqrt(squares(best) / squares(other)));
    }
    return found;
}

}  // namespace searchlight::test
