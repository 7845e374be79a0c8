#include "model/inversion.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "base/error.h"
#include "model/plane.h"

namespace searchlight {

namespace {

// The search runs over s = sqrt(1 - alpha'): near alpha' = 1 total reflectance falls linearly in s. s = 1 is no
// scattering; at s = 0 the mean free path 1/sigma_tr is infinite, so that end is left out.
constexpr double smallest_s = 1e-5;
constexpr int steps = 128;

double alphaOf(double s) { return 1 - s * s; }

void checkTarget(const InversionTarget& target) {
    for (int c = 0; c < target.channels; ++c) {
        if (!(target.Rdr[c] > 0 && target.Rdr[c] <= 1))
            throw inputError(fmt::format("total diffuse reflectance {}", target.Rdr[c]),
                             "expected above 0 and at most 1");
        if (!(target.ld_mm[c] > 0 && std::isfinite(target.ld_mm[c])))
            throw inputError(fmt::format("diffuse mean free path {} mm", target.ld_mm[c]), "expected above 0");
    }
}

Medium mediumOf(Rgb s, Rgb sigma_tp, const InversionTarget& target) {
    Medium medium;
    medium.sigma_a = s * s * sigma_tp;
    medium.sigma_s = 1 / (1 - target.g) * (Rgb{1, 1, 1} - s * s) * sigma_tp;
    medium.g = {target.g, target.g, target.g};
    medium.eta = target.eta;
    medium.channels = target.channels;
    return medium;
}

// sigma_t' from ld = 1/sigma_tr, [Bitterli2013] Eq. 3.3; with Grosjean's D sigma_tr is smaller by sqrt(2 -
// alpha').
double reducedExtinction(double s, double ld_mm, bool grosjean) {
    return (grosjean ? std::sqrt(1 + s * s) : 1) / (ld_mm * std::sqrt(3.0) * s);
}

Rgb reducedExtinction(Rgb s, const Model& model, const InversionTarget& target) {
    Rgb sigma_tp;
    for (int c = 0; c < Rgb::channels; ++c) sigma_tp[c] = reducedExtinction(s[c], target.ld_mm[c], model.file.grosjean);
    return sigma_tp;
}

// Total reflectance of the three channels at s.
using Reflectance = std::function<Rgb(Rgb s)>;

Reflectance reflectanceOf(Evaluator& evaluator, const Model& model, const ParamValues& parameters,
                          const InversionTarget& target) {
    if (hasDiffuseReflectance(model)) {
        evaluator.set(mediumOf(Rgb{0.5, 0.5, 0.5}, {1, 1, 1}, target), parameters);
        return [&evaluator](Rgb s) { return evaluator.diffuseReflectance({alphaOf(s.r), alphaOf(s.g), alphaOf(s.b)}); };
    }
    return [&evaluator, &model, &parameters, &target](Rgb s) {
        // The medium that has this ld: a model may have lengths of its own, such as the thickness of a slab.
        const Medium medium = mediumOf(s, reducedExtinction(s, model, target), target);
        evaluator.set(medium, parameters);
        return totalRd(evaluator, model, medium);
    };
}

/// Samples of the reflectance over s, and per channel the bracket of the root.
struct Search {
    std::array<double, steps + 1> s;
    std::array<Rgb, steps + 1> R;

    explicit Search(const Reflectance& reflectance) {
        for (int i = 0; i <= steps; ++i) {
            const auto k = static_cast<std::size_t>(i);
            // Quadratic: denser towards alpha' = 1. The other end stops short of a medium that does not scatter.
            s[k] = std::lerp(smallest_s, 1 - 1e-9, std::pow(i / static_cast<double>(steps), 2));
            R[k] = reflectance({s[k], s[k], s[k]});
        }
    }

    // The first interval, coming from alpha' = 1, in which the target lies: on that branch more albedo is more light.
    // Negative when there is none.
    int bracket(double target, int c) const {
        for (std::size_t k = 0; k < steps; ++k)
            if ((R[k][c] - target) * (R[k + 1][c] - target) <= 0) return static_cast<int>(k);
        return -1;
    }

    std::size_t nearest(double target, int c) const {
        const auto distance = [&](const Rgb& value) { return std::abs(value[c] - target); };
        return static_cast<std::size_t>(std::ranges::min_element(R, {}, distance) - R.begin());
    }
};

}  // namespace

Inversion invert(Evaluator& evaluator, const Model& model, const ParamValues& parameters,
                 const InversionTarget& target) {
    checkTarget(target);
    const Reflectance reflectance = reflectanceOf(evaluator, model, parameters, target);
    const Search search(reflectance);

    Rgb low, high;
    std::vector<bool> reached;
    for (int c = 0; c < Rgb::channels; ++c) {
        const int k = search.bracket(target.Rdr[c], c);
        reached.push_back(k >= 0);
        const std::size_t nearest = search.nearest(target.Rdr[c], c);
        low[c] = search.s[k >= 0 ? static_cast<std::size_t>(k) : nearest];
        high[c] = search.s[k >= 0 ? static_cast<std::size_t>(k) + 1 : nearest];
    }
    // [Bitterli2013] section 3.4 bisects for the same reason: nothing is known of the function. All channels at once.
    const Rgb at_low = reflectance(low);
    for (int step = 0; step < 60; ++step) {
        const Rgb middle = 0.5 * (low + high);
        const Rgb value = reflectance(middle);
        for (int c = 0; c < Rgb::channels; ++c) {
            const bool same_side = (value[c] > target.Rdr[c]) == (at_low[c] > target.Rdr[c]);
            (same_side ? low : high)[c] = middle[c];
        }
    }

    Inversion result;
    const Rgb s = 0.5 * (low + high);
    for (int c = 0; c < Rgb::channels; ++c) {
        result.alpha_prime[c] = alphaOf(s[c]);
        const auto [min, max] = std::ranges::minmax_element(search.R, {}, [c](const Rgb& value) { return value[c]; });
        result.reachable_min[c] = (*min)[c];
        result.reachable_max[c] = (*max)[c];
    }
    result.medium = mediumOf(s, reducedExtinction(s, model, target), target);
    result.achieved = reflectance(s);
    reached.resize(static_cast<std::size_t>(target.channels));
    result.reached = std::move(reached);
    result.from_profile = !hasDiffuseReflectance(model);
    result.mean_free_path = model.file.grosjean ? "grosjean" : "classical";
    return result;
}

InversionTarget inversionTarget(Evaluator& evaluator, const Model& model, const ParamValues& parameters,
                                const Medium& medium) {
    // Below it ld is longer than anything that is rendered, and Rdr does not see it.
    constexpr double least_s = 1e-4;
    InversionTarget target{
        .eta = medium.eta, .g = (medium.g.r + medium.g.g + medium.g.b) / 3, .channels = medium.channels};
    const Rgb alpha = medium.alphaPrime(), sigma_tp = medium.sigmaTp();
    evaluator.set(medium, parameters);
    const Rgb Rdr =
        hasDiffuseReflectance(model) ? evaluator.diffuseReflectance(alpha) : totalRd(evaluator, model, medium);
    for (int c = 0; c < Rgb::channels; ++c) {
        const double s = std::clamp(std::sqrt(1 - alpha[c]), least_s, 1.0);
        // The relation of sigma_t' and ld is its own inverse.
        target.ld_mm[c] = reducedExtinction(s, sigma_tp[c], model.file.grosjean);
        target.Rdr[c] = std::isfinite(Rdr[c]) ? std::clamp(Rdr[c], 1e-4, 1.0) : 1e-4;
    }
    return target;
}

}  // namespace searchlight
