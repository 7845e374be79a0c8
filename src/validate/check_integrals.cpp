// Energy, and the closed form of the total.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "base/text.h"
#include "model/physics.h"
#include "model/plane.h"
#include "validate/check_bench.h"

namespace searchlight {

namespace {

// Radii over eight decades, logarithmic; a profile that goes as 1/r loses 1e-4 within them.
constexpr double first_radius_mm = 1e-4, last_radius_mm = 1e4, log_step = 0.5;
constexpr int azimuths = 32;

// Directions of exit with weights that sum to 1 and go as T21 cos, which R_d is the mean of Q over
// (docs/conventions.md).
std::vector<std::pair<Vec3, double>> exitDirections(double eta) {
    constexpr int rings = 8, sectors = 8;
    std::vector<std::pair<Vec3, double>> exits;
    double sum = 0;
    for (int i = 0; i < rings; ++i) {
        const double cosine = std::sqrt((i + 0.5) / rings);  // equal parts of cos dw
        const double weight = 1 - Physics<double>::fresnelReflectance(cosine, 1 / eta);
        for (int k = 0; k < sectors; ++k) {
            const double angle = 2 * std::numbers::pi * (k + 0.5) / sectors, sine = std::sqrt(1 - cosine * cosine);
            exits.push_back({{sine * std::cos(angle), sine * std::sin(angle), cosine}, weight});
            sum += weight;
        }
    }
    for (auto& [wo, weight] : exits) weight /= sum;
    return exits;
}

// The plane integral by a product rule that is good to a few 1e-3: totalRd would take minutes where radius, azimuth and
// two angles of exit multiply.
Rgb coarseTotal(CheckBench& bench, const Medium& medium, double angle_deg) {
    const auto exits =
        bench.file().no_wo ? std::vector<std::pair<Vec3, double>>{{{0, 0, 1}, 1.0}} : exitDirections(medium.eta);
    Query query;
    query.wi = pencilBeam(medium.eta, angle_deg).wi;
    query.ni = query.no = {0, 0, 1};
    std::vector<Query> queries;
    std::vector<double> weights;
    for (double r = first_radius_mm; r < last_radius_mm; r *= std::exp(log_step)) {
        for (int k = 0; k < azimuths; ++k) {
            const double angle = 2 * std::numbers::pi * (k + 0.5) / azimuths;
            query.xo = {r * std::cos(angle), r * std::sin(angle), 0};
            for (const auto& [wo, weight] : exits) {
                query.wo = wo;
                queries.push_back(query);
                weights.push_back(weight * 2 * std::numbers::pi / azimuths * r * r * log_step);
            }
        }
    }
    std::vector<Rgb> values(queries.size());
    bench.evaluator().evaluate(queries, values);
    Rgb sum;
    for (std::size_t i = 0; i < values.size(); ++i) sum = sum + weights[i] * values[i];
    return sum;
}

}  // namespace

Total totalOf(CheckBench& bench, const Medium& medium, double angle_deg) {
    bench.pollCancelled();
    bench.evaluator().set(medium, bench.parameters());
    const bool one_dimensional = bench.file().no_wo && (bench.file().radial || angle_deg == 0);
    if (!one_dimensional) return {coarseTotal(bench, medium, angle_deg), 5e-3};
    // In double the integral is good to 1e-10 and a closed form to a few roundings; in float it is a sum of values with
    // relative errors of 1e-6 each, some of them one-sided.
    return {totalRd(bench.evaluator(), bench.model(), medium, angle_deg), bench.isNative() ? 1e-8 : 1e-4};
}

std::vector<double> energyAngles(const CheckBench& bench) {
    // A model that does not read wi returns the same at every angle.
    return bench.file().no_wi ? std::vector<double>{0} : std::vector<double>{0, 45, 80};
}

Finding checkEnergy(CheckBench& bench) {
    const std::vector<double> angles = energyAngles(bench);
    double most = -1, beyond = -1;
    std::string where;
    for (const Medium& medium : checkMedia()) {
        for (const double angle_deg : angles) {
            const auto [sum, accuracy] = totalOf(bench, medium, angle_deg);
            for (int c = 0; c < Rgb::channels; ++c) {
                const std::string place = fmt::format("{}{}", mediumText(medium, c),
                                                      angles.size() > 1 ? fmt::format(", {} deg", angle_deg) : "");
                if (!std::isfinite(sum[c])) return failed(fmt::format("the total is not finite at {}", place));
                beyond = std::max(beyond, sum[c] - 1 - accuracy);
                if (sum[c] > most) {
                    most = sum[c];
                    where = place;
                }
            }
        }
    }
    const std::string found = fmt::format("largest total {} of what entered, at {}", prettyNumber(most), where);
    if (beyond <= 0)
        return passed(bench.file().energy_violation ? found + "; energy_violation is declared but was not found"
                                                    : found);
    if (bench.file().energy_violation) return reported(found + ", as its authors declare");
    // Each part may well be right about what it was made for.
    return bench.model().parts.empty() ? failed(found) : reported(found + ": the parts count some of it twice");
}

Finding checkClosedForm(CheckBench& bench) {
    if (!hasDiffuseReflectance(bench.model())) return skipped("it has no section diffuseReflectance");
    Difference worst;
    for (const Medium& medium : checkMedia()) {
        const auto [integral, tolerance] = totalOf(bench, medium, 0);
        const Rgb closed = bench.evaluator().diffuseReflectance(medium.alphaPrime());
        for (int c = 0; c < Rgb::channels; ++c) {
            const double relative = std::abs(closed[c] - integral[c]) / std::abs(integral[c]);
            // Written so that NaN is a difference.
            if (!(relative <= worst.relative))
                worst = {relative, fmt::format("{}: {} for {}", mediumText(medium, c), prettyNumber(closed[c], 6),
                                               prettyNumber(integral[c], 6))};
            if (!(relative <= tolerance))
                return failed(
                    fmt::format("DiffuseReflectance is off by {} at {}", prettyNumber(relative, 2), worst.where));
        }
    }
    return passed(fmt::format("within {} of the integral", prettyNumber(worst.relative, 2)));
}

}  // namespace searchlight
