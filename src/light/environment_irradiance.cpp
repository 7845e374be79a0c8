#include "light/environment_irradiance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/parallel.h"
#include "light/picture_light.h"
#include "light/transmitted_cosine.h"

namespace searchlight {

namespace {

constexpr double pi = std::numbers::pi;
// T12 cos meets 0 at the horizon without an edge, for eta = 1 with one: the largest error falls as L^-2, and as L^-1.
constexpr int max_order = 64;
constexpr int orders = max_order + 1;
constexpr int table_rows = 181, table_columns = 361;
// Wider than 1024 pixels a picture holds nothing that reaches order 64, half a turn over 64.
constexpr int widest = 1024;

using Harmonics = std::array<std::array<Rgb, 2 * orders>, orders>;  ///< [l][2 m] times cos m phi, [2 m + 1] times sin

// The associated Legendre functions of cos theta, normalised so that their products with cos m phi and sin m phi are
// orthonormal on the sphere. Stable upwards in l [Abramowitz1964, 8.5.3].
class Legendre {
public:
    using Values = std::array<std::array<double, orders>, orders>;  ///< [m][l]

    Legendre() {
        for (int m = 0; m < orders; ++m)
            for (int l = m + 1; l < orders; ++l) {
                const double l2 = l * l, before2 = (l - 1) * (l - 1), m2 = m * m;
                rise_[m][l] = std::sqrt((4 * l2 - 1) / (l2 - m2));
                fall_[m][l] = std::sqrt((before2 - m2) / (4 * before2 - 1));
            }
    }

    Values operator()(double x) const {
        Values p{};
        const double sine = std::sqrt(std::max(0.0, 1 - x * x));
        double diagonal = std::sqrt(1 / (4 * pi));
        for (int m = 0; m < orders; ++m) {
            if (m > 0) diagonal *= sine * std::sqrt((2.0 * m + 1) / (2 * m)) * (m == 1 ? std::numbers::sqrt2 : 1);
            p[m][m] = diagonal;
            for (int l = m + 1; l < orders; ++l)
                p[m][l] = rise_[m][l] * (x * p[m][l - 1] - (l > m + 1 ? fall_[m][l] * p[m][l - 2] : 0));
        }
        return p;
    }

private:
    Values rise_{}, fall_{};
};

struct Waves {
    std::vector<double> cosines, sines;  ///< [m * count + i] at phi_i
    Waves(int count, double first, double step) : cosines(orders * count), sines(orders * count) {
        for (int m = 0; m < orders; ++m)
            for (int i = 0; i < count; ++i) {
                cosines[m * count + i] = std::cos(m * (first + i * step));
                sines[m * count + i] = std::sin(m * (first + i * step));
            }
    }
};

// The eigenvalues of convolution with T12 cos: 2 pi times the integral of T12(mu) mu P_l(mu) [Funk-Hecke].
std::array<double, orders> kernel(double eta) {
    std::array<double, orders> result{};
    // Simpson in s, mu = s^2, so that the steep rise at grazing is resolved; 1e-9 of the value for eta in [1/4, 4].
    // Where there is total reflection the integration starts at the critical cosine.
    const double first = eta < 1 ? std::sqrt(1 - eta * eta) : 0;
    constexpr int steps = 4000;
    for (int i = 0; i <= steps; ++i) {
        const double s = static_cast<double>(i) / steps;
        const double mu = first + (1 - first) * s * s;
        const double weight = (i == 0 || i == steps ? 1 : i % 2 ? 4 : 2) / (3.0 * steps);
        const double value = 2 * pi * weight * 2 * (1 - first) * s * transmittedCosine(mu, eta);
        double before = 0, p = 1;
        for (int l = 0; l < orders; ++l) {
            result[l] += value * p;
            const double next = ((2 * l + 1) * mu * p - l * before) / (l + 1);
            before = p, p = next;
        }
    }
    return result;
}

// The harmonics of the picture as Environment::radiance() interpolates it: bilinear between pixel centres.
Harmonics project(const Image& picture, const Legendre& legendre, int threads) {
    const int w = picture.width, h = picture.height;
    const Waves waves(w, pi / w, 2 * pi / w);
    std::vector<std::array<Rgb, 2 * orders>> rows(h);
    parallelFor(h, threads, [&](std::size_t y) {
        const Rgba* const pixels = &picture.pixels[y * w];
        for (int m = 0; m < orders; ++m) {
            Rgb even, odd;
            for (int x = 0; x < w; ++x) {
                const Rgb value{pixels[x].r, pixels[x].g, pixels[x].b};
                even = even + waves.cosines[m * w + x] * value;
                odd = odd + waves.sines[m * w + x] * value;
            }
            // Integrates the hat between neighbours: sinc^2.
            const double half = m * pi / w;
            const double hat = (half > 0 ? std::pow(std::sin(half) / half, 2) : 1) * 2 * pi / w;
            rows[y][2 * m] = hat * even, rows[y][2 * m + 1] = hat * odd;
        }
    });
    Harmonics result{};
    // The Legendre functions turn once in some 6 degrees: low pictures are cut finer than their rows.
    const int parts = (8 * max_order + h - 1) / h;
    for (int part_row = 0; part_row < (h + 1) * parts; ++part_row) {
        const int cell = part_row / parts;
        const double cell_top = std::max(cell - 0.5, 0.0), cell_bottom = std::min(cell + 0.5, static_cast<double>(h));
        const double step = (cell_bottom - cell_top) / parts;
        const double top = cell_top + (part_row % parts) * step;
        for (const double node : {-1 / std::numbers::sqrt3, 1 / std::numbers::sqrt3}) {  // Gauss, two points
            const double y = top + 0.5 * (1 + node) * step;
            const double theta = pi * y / h;
            const double measure = 0.5 * step * pi / h * std::sin(theta);
            const double t = y - (cell - 0.5);
            const auto& above = rows[std::max(cell - 1, 0)];
            const auto& below = rows[std::min(cell, h - 1)];
            const auto p = legendre(std::cos(theta));
            for (int m = 0; m < orders; ++m)
                for (int part = 2 * m; part < 2 * m + 2; ++part) {
                    const Rgb value = measure * ((1 - t) * above[part] + t * below[part]);
                    for (int l = m; l < orders; ++l) result[l][part] = result[l][part] + p[m][l] * value;
                }
        }
    }
    return result;
}

}  // namespace

EnvironmentIrradiance::EnvironmentIrradiance(const Environment& environment, double eta, int threads)
    : table_(static_cast<std::size_t>(table_rows) * table_columns) {
    const Image& picture = environment.picture();
    const bool small = picture.width <= widest;
    const Legendre legendre;
    Harmonics harmonics = project(small ? picture : shrunk(picture, widest, widest / 2), legendre, threads);
    const std::array<double, orders> by_order = kernel(eta);
    for (int l = 0; l < orders; ++l)
        for (Rgb& value : harmonics[l]) value = by_order[l] * environment.intensity() * value;

    // In the scene's frame: pictureAt() says where a column of normals lies in the picture.
    const double start = environment.pictureAt({0, 0, -1}).x;
    const Waves waves(table_columns, 2 * pi * start, 2 * pi / (table_columns - 1));
    parallelFor(table_rows, threads, [&](std::size_t row) {
        const auto p = legendre(std::cos(pi * static_cast<double>(row) / (table_rows - 1)));
        std::array<Rgb, 2 * orders> parts{};
        for (int m = 0; m < orders; ++m)
            for (int part = 2 * m; part < 2 * m + 2; ++part)
                for (int l = m; l < orders; ++l) parts[part] = parts[part] + p[m][l] * harmonics[l][part];
        for (int column = 0; column < table_columns; ++column) {
            Rgb sum;
            for (int m = 0; m < orders; ++m)
                sum = sum + waves.cosines[m * table_columns + column] * parts[2 * m] +
                      waves.sines[m * table_columns + column] * parts[2 * m + 1];
            for (int c = 0; c < 3; ++c) sum[c] = std::max(sum[c], 0.0);
            table_[row * table_columns + column] = toFloat(sum);
        }
    });
}

Rgbf EnvironmentIrradiance::operator()(Vec3f n) const {
    const float turn = std::atan2(n.x, -n.z) / static_cast<float>(2 * pi);  // from the column of -z
    const float x = (turn < 0 ? turn + 1 : turn) * (table_columns - 1);
    const float y = std::atan2(std::hypot(n.x, n.z), n.y) / static_cast<float>(pi) * (table_rows - 1);
    const int x0 = std::clamp(static_cast<int>(x), 0, table_columns - 2);
    const int y0 = std::clamp(static_cast<int>(y), 0, table_rows - 2);
    const float s = x - static_cast<float>(x0), t = y - static_cast<float>(y0);
    const Rgbf* const at = &table_[static_cast<std::size_t>(y0) * table_columns + x0];
    const auto mix = [&](float Rgbf::*c) {
        return (1 - t) * ((1 - s) * at[0].*c + s * at[1].*c) +
               t * ((1 - s) * at[table_columns].*c + s * at[table_columns + 1].*c);
    };
    return {mix(&Rgbf::r), mix(&Rgbf::g), mix(&Rgbf::b)};
}

}  // namespace searchlight
