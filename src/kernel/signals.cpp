#include "kernel/signals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace searchlight {

namespace {

constexpr double pi = std::numbers::pi;

// Mean over 4 x 4 points of each pixel of f(u, v), u and v in [0, 1).
template <class Function>
Image painted(int size, Function f) {
    constexpr int fine = 4;
    Image image(size, size, {0, 0, 0, 1});
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
            Rgb sum;
            for (int j = 0; j < fine; ++j)
                for (int i = 0; i < fine; ++i)
                    sum = sum + f((x + (i + 0.5) / fine) / size, (y + (j + 0.5) / fine) / size);
            const Rgbf mean = toFloat((1.0 / (fine * fine)) * sum);
            image.at(x, y) = {mean.r, mean.g, mean.b, 1};
        }
    return image;
}

Rgb grey(double value) { return {value, value, value}; }

Image edge(int size) {
    return painted(size, [](double u, double) { return grey(u >= 0.25 && u < 0.75 ? 1 : 0); });
}

// Bands whose sides move by a third of the picture from its top to its bottom, and so repeat.
Image tiltedEdge(int size) {
    return painted(size, [](double u, double v) {
        const double phase = 3 * u + v;
        return grey(phase - std::floor(phase) < 0.5 ? 1 : 0);
    });
}

Image discs(int size) {
    return painted(size, [](double u, double v) {
        constexpr std::array<std::array<double, 3>, 4> list{
            {{0.3, 0.3, 0.2}, {0.72, 0.25, 0.1}, {0.25, 0.75, 0.05}, {0.7, 0.7, 0.16}}};
        for (const auto& [x, y, radius] : list)
            if (std::hypot(u - x, v - y) < radius) return grey(1);
        return grey(0);
    });
}

bool inSquare(double u, double v, double x, double y, double half, double angle_deg) {
    const double c = std::cos(angle_deg * pi / 180), s = std::sin(angle_deg * pi / 180);
    return std::abs(c * (u - x) + s * (v - y)) < half && std::abs(c * (v - y) - s * (u - x)) < half;
}

Image squares(int size) {
    return painted(size, [](double u, double v) {
        // The second square continues the first along its side.
        const double c = std::cos(25 * pi / 180), s = std::sin(25 * pi / 180);
        const bool lit = std::hypot(u - 0.3, v - 0.3) < 0.17 || inSquare(u, v, 0.48, 0.62, 0.1, 25) ||
                         inSquare(u, v, 0.48 + 0.2 * c, 0.62 + 0.2 * s, 0.1, 25);
        return grey(lit ? 1 : 0);
    });
}

Image points(int size) {
    return painted(size, [](double u, double v) {
        const double x = 3 * u - std::floor(3 * u) - 0.5, y = 3 * v - std::floor(3 * v) - 0.5;
        return grey(std::hypot(x, y) < 0.06 ? 1 : 0);
    });
}

// Repeating noise in about [-1, 1] at every pixel: waves of whole numbers along both sides, with phases from a hash.
std::vector<double> waves(int size, int lowest, int highest, unsigned seed) {
    constexpr int count = 24;
    std::vector<double> noise(static_cast<std::size_t>(size) * size), table(static_cast<std::size_t>(size));
    double total = 0;
    for (int k = 0; k < count; ++k) {
        unsigned hash = (seed * 977u + static_cast<unsigned>(k)) * 2654435761u;
        hash = (hash ^ (hash >> 15)) * 2246822519u;
        hash ^= hash >> 13;
        const double frequency = lowest * std::pow(static_cast<double>(highest) / lowest, k / (count - 1.0));
        const double weight = 1 / std::sqrt(frequency), turn = 2 * pi * (hash & 1023u) / 1024.0;
        const double phase = 2 * pi * ((hash >> 10) & 1023u) / 1024.0;
        const int a = static_cast<int>(std::lround(frequency * std::cos(turn)));
        const int b = static_cast<int>(std::lround(frequency * std::sin(turn)));
        for (int i = 0; i < size; ++i)
            table[static_cast<std::size_t>(i)] = weight * std::cos(2 * pi * i / size + phase);
        for (int y = 0; y < size; ++y)
            for (int x = 0; x < size; ++x)
                noise[static_cast<std::size_t>(y * size + x)] +=
                    table[static_cast<std::size_t>(((a * x + b * y) % size + size) % size)];
        total += weight;
    }
    for (double& value : noise) value *= 2.2 / total;
    return noise;
}

// Pores and blood.
std::vector<Rgb> skin(int size) {
    const std::vector<double> pores = waves(size, 12, 40, 1), blood = waves(size, 2, 7, 2);
    std::vector<Rgb> color;
    for (std::size_t i = 0; i < pores.size(); ++i)
        color.push_back({0.80 * (1 + 0.05 * pores[i] + 0.03 * blood[i]), 0.55 * (1 + 0.12 * pores[i] - 0.10 * blood[i]),
                         0.45 * (1 + 0.14 * pores[i] - 0.10 * blood[i])});
    return color;
}

void multiply(Image& image, const std::vector<Rgb>& color) {
    for (std::size_t i = 0; i < color.size(); ++i) {
        Rgba& pixel = image.pixels[i];
        const Rgbf product = toFloat(color[i] * Rgb{pixel.r, pixel.g, pixel.b});
        pixel = {std::clamp(product.r, 0.0f, 1.0f), std::clamp(product.g, 0.0f, 1.0f),
                 std::clamp(product.b, 0.0f, 1.0f), 1};
    }
}

Image uniformPatch(int size) {
    const std::vector<Rgb> color = skin(size);
    Image image = painted(size, [](double, double) { return grey(0.9); });
    multiply(image, color);
    return image;
}

// A nose's worth of bumps under a low light from the left, and the shadow that it throws.
Image shadedPatch(int size) {
    const std::vector<Rgb> color = skin(size);
    const std::vector<double> bumps = waves(size, 3, 9, 3);
    Image image = painted(size, [&](double u, double v) {
        const auto at = static_cast<std::size_t>(static_cast<int>(v * size) * size + static_cast<int>(u * size));
        const double slope = 0.9 * std::cos(2 * pi * u) * (1 + 0.3 * std::cos(2 * pi * v)) + 0.35 * bumps[at];
        const double cosine = std::max(0.0, (0.55 + 0.8 * slope) / std::sqrt(1 + slope * slope));
        const bool shadow = std::hypot((u - 0.62) / 0.13, (v - 0.5 - 0.08 * std::sin(9 * u)) / 0.32) < 1;
        return grey(shadow ? 0.02 : 0.05 + cosine);
    });
    multiply(image, color);
    return image;
}

}  // namespace

std::span<const Signal> signals() {
    static constexpr std::array<Signal, 7> list{{{"edge", "an upright edge", edge},
                                                 {"tilted_edge", "edges at 18 degrees", tiltedEdge},
                                                 {"discs", "discs of four sizes", discs},
                                                 {"squares", "a circle and two tilted squares", squares},
                                                 {"points", "points of light", points},
                                                 {"shaded", "a patch of skin, shaded", shadedPatch},
                                                 {"uniform", "a patch of skin, evenly lit", uniformPatch}}};
    return list;
}

}  // namespace searchlight
