#include "transport/half_space/importance.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "transport/walk/diffusion.h"

namespace searchlight {

namespace {

// How deep a walk is split that is about to leave, in reduced mean free paths.
constexpr double kShallow = 0.3;

struct Dipole {
    double decay, extrapolation;

    // Exitance at lateral distance^2 d2 of a source at depth z.
    double operator()(double d2, double z) const {
        const auto pole = [&](double depth) {
            const double d = std::sqrt(d2 + depth * depth);
            return depth * (1 + decay * d) * std::exp(-decay * d) / (d * d * d);
        };
        return pole(z) + pole(z + 2 * extrapolation);
    }

    // Mean over the circle of radius r for a source at distance rho from its axis.
    double ring(double r, double rho, double z) const {
        constexpr int azimuths = 8;
        double sum = 0;
        for (int i = 0; i < azimuths; ++i) {
            const double c = std::cos((i + 0.5) * std::numbers::pi / azimuths);
            sum += (*this)(r * r + rho * rho - 2 * r * rho * c, z);
        }
        return sum / azimuths;
    }
};

}  // namespace

BestTuning tuningFor(const HalfSpaceWalk& walk) {
    BestTuning tuning;
    // Where most is absorbed, what leaves far out comes from one or two long flights.
    if (walk.absorbed > 0.5) tuning.stretched = 0.5;
    // A walk that is scattered forward takes many collisions to the surface and few from there to its exit: parts of a
    // walk that is split close to it are cheap. Fitted for g 0.3 to 0.95, 1 - albedo 1e-4 to 0.7.
    const double reduced_rate = 1 - walk.g * (1 - walk.absorbed);
    tuning.shallow = std::max(0.0, 3.5 / reduced_rate - 4);
    // Without guided walks (GuidedWalk::useful) the moments rest on walks that leave between the places that count.
    if (walk.g > 0.4 && walk.absorbed >= 0.45 * reduced_rate) tuning.total = 0.2;
    return tuning;
}

ImportanceTable makeImportanceTable(const HalfSpaceWalk& walk, std::span<const double> edges,
                                    const BestTuning& tuning) {
    // Lengths in reduced mean free paths from here on.
    const double reduced_rate = 1 - walk.g * (1 - walk.absorbed);
    const Dipole dipole{asymptoticDecay(walk.absorbed / reduced_rate), extrapolation(walk.eta)};

    // Bins closer than the first collision or farther than where walks can still be led get what comes.
    constexpr double nearest = 0.3, farthest = 12;
    constexpr int rings = 8;
    const double low = std::clamp(edges.front() * reduced_rate, nearest, farthest);
    const double high = std::clamp(edges.back() * reduced_rate, low, farthest);
    double radii[rings], reference[rings], part[rings], parts = 0;
    for (int k = 0; k < rings; ++k) {
        radii[k] = low * std::pow(high / low, static_cast<double>(k) / (rings - 1));
        reference[k] = dipole.ring(radii[k], 0, 1);
        parts += part[k] = std::pow(radii[k], tuning.far);
    }

    ImportanceTable table;
    table.ahead = static_cast<float>(tuning.ahead * walk.g * (1 - walk.absorbed) / reduced_rate);
    table.decay = dipole.decay * reduced_rate;
    const double unit = 0.35 / reduced_rate;  // the first cells reach this far
    table.offset = static_cast<float>(unit * unit);
    constexpr int n = ImportanceTable::kCells, shift = 23 - ImportanceTable::kMantissaBits;
    double centres[n];
    for (int i = 0; i < n; ++i) {
        const auto bits = std::bit_cast<std::int32_t>(table.offset) + (i << shift) + (1 << (shift - 1));
        centres[i] = std::sqrt(static_cast<double>(std::bit_cast<float>(bits)) - table.offset) * reduced_rate;
    }
    table.value.reserve(n * n);
    for (const double z : centres)
        for (const double rho : centres) {
            // Root mean square over the rings: then the sum of their relative variances is small. The total counts a
            // little, too: without it what leaves beyond the bins would rest on a few heavy walks.
            const double leaves = tuning.total * std::exp(-dipole.decay * z);
            double square = leaves * leaves;
            for (int k = 0; k < rings; ++k) {
                const double gain = dipole.ring(radii[k], rho, z + tuning.depth) / reference[k];
                square += part[k] / parts * gain * gain;
            }
            const double near = 1 + tuning.shallow * std::exp(-z / kShallow);
            // Bounds keep weights, their inverse, from running away.
            table.value.push_back(static_cast<float>(std::clamp(near * std::sqrt(square), 1e-5, 1e3)));
        }
    return table;
}

}  // namespace searchlight
