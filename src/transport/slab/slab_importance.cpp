#include "transport/slab/slab_importance.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "transport/walk/diffusion.h"

namespace searchlight {

namespace {

// As in importance.h, measured there for the half-space. The total counts for more here, for angles and depths.
constexpr double kFar = 0.4, kTotal = 0.1, kDepth = 0.25;

// Lengths in reduced mean free paths of the layers' mean.
struct MeanSlab {
    double mfp_mm = 1;
    double decay = 0;
    double thickness = 0;  ///< infinity: no lower side
    double above = 0;      ///< extrapolation at the top
    double below = 0;      ///< and at the bottom

    // Exitance at the lateral distance^2 d2 through the top, of a source at depth z of a slab with these
    // extrapolations: the multipole of [DonnerJensen2005] with the first images on either side.
    double exitance(double d2, double z, double near, double far) const {
        const auto pole = [&](double h) {
            const double d = std::sqrt(d2 + h * h);
            return h * (1 + decay * d) * std::exp(-decay * d) / (d * d * d);
        };
        const double first = pole(z) + pole(z + 2 * near);
        if (std::isinf(thickness)) return first;
        const double period = 2 * (thickness + near + far);
        double sum = first;
        for (const double shift : {-period, period}) sum += pole(shift + z) - pole(shift - 2 * near - z);
        // The images are cut off, and may fall short far out.
        return std::max(sum, 0.02 * first);
    }

    // Mean over the circle of radius r for a source at distance rho from its axis.
    double ring(double r, double rho, double z, bool top) const {
        const double near = top ? above : below, far = top ? below : above;
        const double depth = std::min((top ? z : thickness - z) + kDepth, thickness + 0.5 * far);
        constexpr int azimuths = 4;
        double sum = 0;
        for (int i = 0; i < azimuths; ++i) {
            const double c = std::cos((i + 0.5) * std::numbers::pi / azimuths);
            sum += exitance(r * r + rho * rho - 2 * r * rho * c, depth, near, far);
        }
        return sum / azimuths;
    }
};

// Per mm.
double reducedRate(const SlabWalk::Layer& layer) { return (1 - layer.g * (1 - layer.absorbed)) / layer.mfp_mm; }

MeanSlab meanOf(const SlabWalk& walk) {
    constexpr double deep = 10;  // reduced mean free paths of a layer without end that count
    double length = 0, optical = 0, absorbed = 0;
    MeanSlab mean;
    for (const SlabWalk::Layer& layer : walk.layers) {
        const bool endless = std::isinf(layer.thickness_mm);
        const double thickness = endless ? deep / reducedRate(layer) : layer.thickness_mm;
        length += thickness;
        optical += thickness * reducedRate(layer);
        absorbed += thickness * layer.absorbed / layer.mfp_mm;
        mean.thickness += layer.thickness_mm * reducedRate(layer);
    }
    mean.mfp_mm = optical > 0 ? length / optical : 1;
    mean.decay = asymptoticDecay(optical > 0 ? std::min(1.0, absorbed / optical) : 1);
    mean.above = extrapolation(walk.layers.front().eta_up);
    mean.below = extrapolation(walk.layers.back().eta_down);
    return mean;
}

}  // namespace

double decayPerMfp(const SlabWalk::Layer& layer) {
    const double reduced = 1 - layer.g * (1 - layer.absorbed);
    return reduced * asymptoticDecay(std::min(1.0, layer.absorbed / reduced));
}

bool isOpaque(const SlabWalk& walk) {
    constexpr double opaque = 8;
    const MeanSlab mean = meanOf(walk);
    return !(mean.thickness * std::max(mean.decay, 0.01) < opaque);
}

SlabImportance makeSlabImportance(const SlabWalk& walk, std::span<const double> edges) {
    const MeanSlab mean = meanOf(walk);
    const bool through = !isOpaque(walk);

    // Walks that are led through a thick slab are long. This leaves as much time for those that come back.
    const double part_below = 1 / (1 + 0.25 * mean.thickness);

    constexpr double nearest = 0.3, farthest = 12;
    constexpr int rings = 6;
    const double low = std::clamp(edges.front() / mean.mfp_mm, nearest, farthest);
    const double high = std::clamp(edges.back() / mean.mfp_mm, low, farthest);
    const double source = std::min(1.0, 0.5 * mean.thickness);
    double radii[rings], part[rings], parts = 0, reference[2][rings];
    for (int k = 0; k < rings; ++k) {
        radii[k] = low * std::pow(high / low, static_cast<double>(k) / (rings - 1));
        reference[0][k] = mean.ring(radii[k], 0, source, true);
        reference[1][k] = through ? mean.ring(radii[k], 0, source, false) : 1;
        parts += part[k] = std::pow(radii[k], kFar);
    }

    SlabImportance table;
    const double unit = 0.35;  // the first columns reach this far
    table.offset = static_cast<float>(unit * unit * mean.mfp_mm * mean.mfp_mm);
    constexpr int shift = 23 - SlabImportance::kMantissaBits;
    double columns[SlabImportance::kColumns];
    for (int i = 0; i < SlabImportance::kColumns; ++i) {
        const auto bits = std::bit_cast<std::int32_t>(table.offset) + (i << shift) + (1 << (shift - 1));
        columns[i] =
            std::sqrt(std::max(0.0, static_cast<double>(std::bit_cast<float>(bits)) - table.offset)) / mean.mfp_mm;
    }
    const auto importance = [&](double z, double rho) {
        const double up = std::exp(-mean.decay * z);
        const double down = through ? std::exp(-mean.decay * (mean.thickness - z)) : 0;
        double square = kTotal * kTotal * (up * up + down * down);
        for (int k = 0; k < rings; ++k) {
            const double gain = mean.ring(radii[k], rho, z, true) / reference[0][k];
            const double gain_below = through ? part_below * mean.ring(radii[k], rho, z, false) / reference[1][k] : 0;
            square += part[k] / parts * (gain * gain + gain_below * gain_below);
        }
        // Bounds keep weights, their inverse, from running away.
        return static_cast<float>(std::clamp(std::sqrt(square), 1e-5, 5.0));
    };
    double top = 0;
    for (const SlabWalk::Layer& layer : walk.layers) {
        const double rate = reducedRate(layer);
        const double depth = std::isinf(layer.thickness_mm) ? farthest : layer.thickness_mm * rate;
        SlabImportance::Layer& rows = table.layers.emplace_back();
        rows.first_row = static_cast<std::int32_t>(table.value.size()) / SlabImportance::kColumns;
        rows.rows = static_cast<std::int32_t>(std::clamp(4 * depth, 1.0, 40.0));
        rows.rows_per_mm = depth > 0 ? static_cast<float>(rows.rows * rate / depth) : 0;
        // Every second row from diffusion, those between from their neighbours.
        const auto row = [&](int i) {
            std::vector<float> values;
            for (const double rho : columns) values.push_back(importance(top + depth * (i + 0.5) / rows.rows, rho));
            return values;
        };
        std::vector<float> above, below = row(0);
        for (int i = 0; i < rows.rows; ++i) {
            if (i % 2 == 0) {
                above = std::exchange(below, {});
                table.value.insert(table.value.end(), above.begin(), above.end());
                if (i + 1 < rows.rows) below = row(std::min(i + 2, rows.rows - 1));
                continue;
            }
            for (std::size_t k = 0; k < above.size(); ++k) table.value.push_back(std::sqrt(above[k] * below[k]));
        }
        top += depth;
    }
    return table;
}

}  // namespace searchlight
