// Finite, non-negative, and finite at the ends of every parameter.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/text.h"
#include "validate/check_bench.h"

namespace searchlight {

namespace {

// The first value that is not finite, in words.
std::optional<std::string> notFinite(const Medium& medium, const Probe& probe, const std::vector<Rgb>& values) {
    for (std::size_t i = 0; i < values.size(); ++i)
        for (int c = 0; c < Rgb::channels; ++c)
            if (!std::isfinite(values[i][c]))
                return fmt::format("{} at r {} mm, {}", std::isnan(values[i][c]) ? "NaN" : "infinity",
                                   prettyNumber(probe.radius(i), 3), mediumText(medium, c));
    return {};
}

// Where a user can take a parameter. Colours have no upper end: black and white.
std::vector<ParamValue> ends(const Param& param) {
    switch (param.type) {
        case ParamType::toggle: return {false, true};
        case ParamType::color: return {Rgb{0, 0, 0}, Rgb{1, 1, 1}};
        case ParamType::choice: return {param.choices.begin(), param.choices.end()};
        default: return {param.min, param.max};
    }
}

Medium withoutAbsorption(Medium medium) {
    medium.sigma_a = {0, 0, 0};
    return medium;
}

}  // namespace

Finding checkFinite(CheckBench& bench) {
    std::size_t count = 0;
    for (const bool tilted : {false, true}) {
        const Probe probe = makeProbe({.tilted_exit = tilted});
        for (const Medium& medium : checkMedia()) {
            const std::vector<Rgb> values = bench.values(medium, probe);
            if (const auto fault = notFinite(medium, probe, values)) return failed(*fault);
            count += values.size();
        }
    }
    const Probe probe = makeProbe();
    const Medium white = withoutAbsorption(checkMedia().front());
    if (const auto fault = notFinite(white, probe, bench.values(white, probe)))
        return reported(fmt::format("a medium that absorbs nothing gives {}", *fault));
    return passed(fmt::format("{} values, alpha' 0.1 to 1, r 0.001 to 30 mean free paths", 3 * count));
}

LeastValue leastValue(CheckBench& bench, std::span<const Medium> media) {
    const Probe probe = makeProbe();
    LeastValue least;
    for (const Medium& medium : media) {
        const std::vector<Rgb> values = bench.values(medium, probe);
        for (int c = 0; c < Rgb::channels; ++c) {
            const auto weighted = [&](std::size_t i) { return std::pow(probe.radius(i), 2) * values[i][c]; };
            double largest = 0;
            for (std::size_t i = 0; i < values.size(); ++i) largest = std::max(largest, std::abs(weighted(i)));
            for (std::size_t i = 0; i < values.size(); ++i)
                if (weighted(i) < least.share * largest)
                    least = {values[i][c], weighted(i) / largest,
                             fmt::format("r {} mm, {}", prettyNumber(probe.radius(i), 3), mediumText(medium, c))};
        }
    }
    return least;
}

Finding checkNonNegative(CheckBench& bench) {
    const LeastValue least = leastValue(bench, checkMedia());
    if (least.value == 0) return passed(fmt::format("{} values", 3 * makeProbe().queries.size() * checkMedia().size()));
    const std::string found = fmt::format("{} 1/mm^2 at {}", prettyNumber(least.value), least.where);
    // Float rounds differences that far below the largest value to either side of zero.
    return least.share < -1e-6 ? failed(found) : reported(found + ": as small as rounding makes it");
}

Finding checkParameterEnds(CheckBench& bench) {
    const std::vector<Param>& params = bench.file().parameters;
    if (params.empty()) return skipped("it has no parameters");
    const Probe probe = makeProbe({.radii = 20, .directions = 4});
    int settings = 0;
    for (const Param& param : params) {
        for (const ParamValue& end : ends(param)) {
            ParamValues values = bench.parameters();
            values.insert_or_assign(param.name, end);
            for (const Medium& medium : checkMedia())
                if (const auto fault = notFinite(medium, probe, bench.values(medium, probe, values)))
                    return failed(fmt::format("{} = {}: {}", param.name, valueText(end), *fault));
            ++settings;
        }
    }
    return passed(fmt::format("{} settings of {} parameter{}", settings, params.size(), params.size() == 1 ? "" : "s"));
}

}  // namespace searchlight
