#include "render/exitance/radial_table.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/parallel.h"

namespace searchlight {

namespace {

constexpr int nodes_per_bin = RadialKernel::nodes_per_octave >> RadialTable::Impl::mantissa_bits;
static_assert(nodes_per_bin == 2, "a bin has a node at either end and one at its centre");

// Coefficients in z = (w - centre) / scale of the polynomial of degree 4 that is nearest, in least squares, to nine
// nodes. More nodes than coefficients: a profile made of cubics has steps in its second derivative, which are no
// physics, and an expansion must not see them.
constexpr std::size_t fit_nodes = 9, fit_terms = 5;

using Fit = std::array<Rgb, fit_terms>;

Fit fitPolynomial(const RadialKernel& kernel, std::size_t first, double centre, double scale) {
    double matrix[fit_terms][fit_terms] = {};
    Fit right{};
    for (std::size_t k = first; k < first + fit_nodes; ++k) {
        const double z = (kernel.node(k) - centre) / scale;
        double powers[2 * fit_terms - 1] = {1};
        for (std::size_t i = 1; i < 2 * fit_terms - 1; ++i) powers[i] = z * powers[i - 1];
        for (std::size_t i = 0; i < fit_terms; ++i) {
            right[i] = right[i] + powers[i] * kernel.values()[k];
            for (std::size_t j = 0; j < fit_terms; ++j) matrix[i][j] += powers[i + j];
        }
    }
    // Symmetric and positive definite: elimination needs no pivots. |z| <= 1 keeps it well conditioned.
    for (std::size_t i = 0; i < fit_terms; ++i)
        for (std::size_t j = i + 1; j < fit_terms; ++j) {
            const double factor = matrix[j][i] / matrix[i][i];
            for (std::size_t k = i; k < fit_terms; ++k) matrix[j][k] -= factor * matrix[i][k];
            right[j] = right[j] - factor * right[i];
        }
    for (std::size_t i = fit_terms; i-- > 0;) {
        for (std::size_t j = i + 1; j < fit_terms; ++j) right[i] = right[i] - matrix[i][j] * right[j];
        right[i] = (1 / matrix[i][i]) * right[i];
    }
    return right;
}

// The third derivative of f(|x|^2 + c^2) along a unit vector at cosine mu to x is 12 f'' r mu + 8 f''' r^3 mu^3.
double thirdDerivative(double r, double second, double third) {
    const auto along = [&](double mu) { return std::abs(mu * (12 * second * r + 8 * third * r * r * r * mu * mu)); };
    double largest = along(1);
    const double square = -second / (2 * third * r * r);
    if (square > 0 && square < 1) largest = std::max(largest, along(std::sqrt(square)));
    return largest;
}

// Of numbers below this nothing is left in a sum, and products of denormal numbers are slow.
float flushed(double value) { return std::abs(value) < 1e-30 ? 0.0f : static_cast<float>(value); }

}  // namespace

RadialTable::Impl::Impl(const Profile& profile, double cell_area_mm2) {
    const RadialKernel kernel(profile, cell_area_mm2);
    offset = static_cast<float>(kernel.offset());
    base = std::bit_cast<std::uint32_t>(offset) >> shift;
    total = kernel.total();
    mean_square_radius = kernel.meanSquareRadius();
    const std::size_t bins = (kernel.values().size() - 1) / nodes_per_bin;
    entries.resize(bins + 1);
    radii.resize(bins + 1);
    values.resize(bins + 1);
    third.emplace_back(bins + 1);
    fingerprint = 0xcbf29ce484222325;
    for (std::size_t i = 0; i < bins; ++i) {
        const double centre = kernel.node(nodes_per_bin * i + 1);
        const std::size_t wanted = std::max<std::size_t>(nodes_per_bin * i + 1, fit_nodes / 2) - fit_nodes / 2;
        const std::size_t first = std::min(wanted, kernel.values().size() - fit_nodes);
        const double scale = std::max(kernel.node(first + fit_nodes - 1) - centre, centre - kernel.node(first));
        const Fit fit = fitPolynomial(kernel, first, centre, scale);
        radii[i] = std::sqrt(centre - kernel.offset());
        for (int c = 0; c < Rgb::channels; ++c) {
            // Beyond the end: the polynomial still sees what lies before it.
            bool ended = true;
            for (std::size_t k = nodes_per_bin * i; k <= nodes_per_bin * (i + 1); ++k)
                ended = ended && kernel.values()[k][c] == 0;
            if (ended) continue;
            const double derivatives[] = {fit[0][c], fit[1][c] / scale, 2 * fit[2][c] / (scale * scale),
                                          6 * fit[3][c] / (scale * scale * scale)};
            values[i][c] = std::abs(derivatives[0]);
            third[0][i][c] = thirdDerivative(radii[i], derivatives[2], derivatives[3]);
            for (int k = 0; k < RadialEntry::stride; ++k) {
                const float value = flushed(derivatives[k]);
                entries[i].value[static_cast<std::size_t>(RadialEntry::stride * c + k)] = value;
                fingerprint = (fingerprint ^ std::bit_cast<std::uint32_t>(value)) * 0x100000001b3;
            }
        }
    }
    for (std::size_t span = 1; 2 * span <= bins + 1; span *= 2) {
        std::vector<Rgb> maxima(bins + 2 - 2 * span);
        for (std::size_t i = 0; i < maxima.size(); ++i)
            for (int c = 0; c < Rgb::channels; ++c)
                maxima[i][c] = std::max(third.back()[i][c], third.back()[i + span][c]);
        third.push_back(std::move(maxima));
    }
    radii.back() = std::sqrt(kernel.node(kernel.values().size() - 1) - kernel.offset());
    fingerprint = (fingerprint ^ base) * 0x100000001b3;
}

double RadialTable::Impl::largestThird(double r0, double r1, int channel) const {
    const auto at = [&](double r) { return bin(static_cast<float>(std::min(r * r, 1e30)) + offset); };
    const std::uint32_t first = at(std::max(r0, 0.0)), last = at(r1);
    const auto level = static_cast<std::size_t>(std::bit_width(last - first + 1) - 1);
    const std::vector<Rgb>& maxima = third[level];
    return std::max(maxima[first][channel], maxima[last + 1 - (1u << level)][channel]);
}

std::uint32_t RadialTable::Impl::bin(float w) const {
    const std::uint32_t index = (std::bit_cast<std::uint32_t>(w) >> shift) - base;
    return std::min(index, static_cast<std::uint32_t>(entries.size() - 1));
}

RadialTable::RadialTable(const Profile& profile, double cell_area_mm2)
    : impl_(std::make_unique<Impl>(profile, cell_area_mm2)) {}
RadialTable::~RadialTable() = default;
RadialTable::RadialTable(RadialTable&&) noexcept = default;
RadialTable& RadialTable::operator=(RadialTable&&) noexcept = default;

Rgb RadialTable::operator()(double r_mm) const {
    const auto w = static_cast<float>(r_mm * r_mm + static_cast<double>(impl_->offset));
    const std::uint32_t bits = std::bit_cast<std::uint32_t>(w);
    const std::uint32_t low = (1u << Impl::shift) - 1, half = 1u << (Impl::shift - 1);
    const double step = static_cast<double>(w) - static_cast<double>(std::bit_cast<float>((bits & ~low) | half));
    const auto& entry = impl_->entries[impl_->bin(w)].value;
    Rgb R;
    for (int c = 0; c < Rgb::channels; ++c) {
        const auto at = static_cast<std::size_t>(RadialEntry::stride * c);
        R[c] = entry[at] + step * (entry[at + 1] + step * 0.5 * entry[at + 2]);
    }
    return R;
}

Opening openingOf(const RadialTable::Impl& table, Rgb opening, double area_mm2, int threads) {
    // How much a large R_d excuses. With 1 the pairs close to a receiver, which are few and do not average out, make
    // most of the error; with 0.1 the same error takes a quarter less time.
    constexpr double near = 0.1;
    // Larger than any sum of radii, and its square is still a float.
    constexpr double everything = 1e18;
    std::vector<float> distances(table.entries.size(), static_cast<float>(everything));
    double crowding = 0;
    for (int c = 0; c < Rgb::channels; ++c) {
        if (opening[c] <= 0 || table.mean_square_radius[c] == 0) continue;
        const double spread = std::min(area_mm2, std::numbers::pi * table.mean_square_radius[c]);
        const double mean = std::abs(table.total[c]) / spread;
        crowding = std::max(crowding, 1 / spread);
        const auto distanceAt = [&](std::size_t i) {
            const double allowed = 6 * opening[c] * (near * table.values[i][c] + mean);
            // The remainder is a third derivative somewhere between r - s and r + s. The reach falls as the interval
            // grows: s is where both meet.
            const auto reach = [&](double s) {
                const double largest = table.largestThird(table.radii[i] - s, table.radii[i] + s, c);
                // In float: it is some ten times as fast, and the rule is no sharper than a hundredth.
                return largest > 0 ? std::min<double>(std::cbrt(static_cast<float>(allowed / largest)), everything)
                                   : everything;
            };
            double high = reach(0), low = reach(high);
            for (int step = 0; step < 8 && low < 0.98 * high; ++step) {
                const double middle = std::sqrt(low * high), there = reach(middle);
                if (there < middle) {
                    high = middle;
                    low = std::max(low, there);
                } else {
                    low = middle;
                    high = std::min(high, there);
                }
            }
            return static_cast<float>(low);
        };
        constexpr std::size_t grain = 128;
        const std::size_t bins = distances.size() - 1;
        parallelFor((bins + grain - 1) / grain, threads, [&](std::size_t task) {
            for (std::size_t i = task * grain; i < std::min(bins, (task + 1) * grain); ++i)
                distances[i] = std::min(distances[i], distanceAt(i));
        });
        // The last bin holds all distances from its own on: the least of them must not reach back to where R_d is.
        std::size_t end = distances.size() - 1;
        while (end > 0 && table.values[end - 1][c] == 0) --end;
        distances.back() = std::min(distances.back(), static_cast<float>(table.radii.back() - table.radii[end]));
    }
    return {std::move(distances), static_cast<float>(std::cbrt(crowding))};
}

}  // namespace searchlight
