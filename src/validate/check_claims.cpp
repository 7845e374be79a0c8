// What must not change the value: the unit of length, and whatever the first line of the file claims not to matter.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "base/text.h"
#include "validate/check_bench.h"

namespace searchlight {

namespace {

Probe changed(Probe probe, const std::function<void(Query&, unsigned)>& change) {
    unsigned index = 1000;  // away from the points that made the probe
    for (Query& query : probe.queries) change(query, ++index);
    return probe;
}

// The largest change over the media when the queries are changed.
Difference changeOf(CheckBench& bench, std::span<const Medium> media,
                    const std::function<void(Query&, unsigned)>& change) {
    const Probe before = makeProbe();
    const Probe after = changed(before, change);
    Difference worst;
    for (const Medium& medium : media)
        worst.see(CheckBench::difference(medium, before, bench.values(medium, before), bench.values(medium, after)));
    return worst;
}

// A claim that holds or not; a claim that could be made is worth a word, since programs are faster with it.
Finding claim(CheckBench& bench, bool claimed, std::string_view attribute, std::string_view what,
              const std::function<void(Query&, unsigned)>& change) {
    const Difference found = changeOf(bench, checkMedia(), change);
    const bool holds = found.relative <= bench.rounding();
    if (claimed && !holds)
        return failed(
            fmt::format("{} changes the value by {} at {}", what, prettyNumber(found.relative, 2), found.where));
    if (claimed && found.relative == 0) return passed(fmt::format("{} changes nothing", what));
    if (claimed)
        return passed(fmt::format("{} changes the value by {} at most", what, prettyNumber(found.relative, 2)));
    if (holds)
        return reported(fmt::format("not claimed, but it holds: '{}' in the first line makes it faster", attribute));
    return skipped("not claimed");
}

// Powers of the length in a unit that a parameter may have.
int lengthPower(std::string_view unit) {
    if (unit == "mm") return 1;
    if (unit == "1/mm") return -1;
    return unit == "1/mm^2" ? -2 : unit == "mm^2" ? 2 : 0;
}

// The parameters in a world `scale` times as large; false when one would leave its range.
bool scaleParameters(CheckBench& bench, double scale, ParamValues& values) {
    values = bench.parameters();
    for (const Param& param : bench.file().parameters) {
        const int power = lengthPower(param.unit);
        const ParamValue& value = valueOf(param, bench.parameters());
        if (power == 0) continue;
        if (std::holds_alternative<Rgb>(value))  // as a colour it has no upper end
            values.insert_or_assign(param.name, std::pow(scale, power) * std::get<Rgb>(value));
        if (!std::holds_alternative<double>(value)) continue;
        const double scaled_value = std::get<double>(value) * std::pow(scale, power);
        if (scaled_value < param.min || scaled_value > param.max) return false;
        values.insert_or_assign(param.name, scaled_value);
    }
    return true;
}

}  // namespace

Difference scalingDifference(CheckBench& bench, std::span<const Medium> media, int& scales) {
    const Probe probe = makeProbe();
    Difference worst;
    scales = 0;
    for (const double scale : {10.0, 0.1, 2.0, 0.5}) {
        ParamValues parameters;
        if (!scaleParameters(bench, scale, parameters)) continue;
        ++scales;
        const Probe large = changed(probe, [&](Query& query, unsigned) { query.xo = scale * query.xo; });
        for (const Medium& medium : media) {
            const std::vector<Rgb> before = bench.values(medium, probe);
            std::vector<Rgb> after = bench.values(scaled(medium, scale), large, parameters);
            for (Rgb& value : after) value = scale * scale * value;
            Difference found = CheckBench::difference(medium, probe, before, after);
            found.where += fmt::format(", lengths times {}", scale);
            worst.see(found);
        }
    }
    return worst;
}

Finding checkScaling(CheckBench& bench) {
    if (bench.model().measured || !bench.readsMedium())
        return reported("it does not read the medium: valid for the material it was made for, at that size only");
    int scales = 0;
    const Difference worst = scalingDifference(bench, checkMedia(), scales);
    if (scales == 0) return skipped("no scale keeps the parameters that are lengths in their ranges");
    if (worst.relative > bench.rounding())
        return failed(fmt::format("off by {} at {}", prettyNumber(worst.relative, 2), worst.where));
    return passed(fmt::format("within {} for lengths times 0.1 to 10", prettyNumber(worst.relative, 2)));
}

Finding checkRadial(CheckBench& bench) {
    // The pair of points is turned freely in space and moved by about its own distance: farther away, the rounding of
    // positions would hide small values. Directions and normals stay.
    return claim(bench, bench.file().radial, "radial", "moving and turning the two points",
                 [](Query& query, unsigned index) {
                     const auto u = haltonPoint(index);
                     const double r = length(query.xo - query.xi);
                     const double z = 2 * u[0] - 1, turn = 6.283185307179586 * u[1];
                     const double flat = std::sqrt(1 - z * z);
                     query.xi = r * Vec3{u[2] - 0.5, u[3] - 0.5, u[4] - 0.5};
                     query.xo = query.xi + r * Vec3{flat * std::cos(turn), flat * std::sin(turn), z};
                 });
}

Finding checkNoWi(CheckBench& bench) {
    return claim(bench, bench.file().no_wi, "no_wi", "another direction of incidence",
                 [](Query& query, unsigned index) {
                     const auto u = haltonPoint(index);
                     query.wi = hemisphereDirection(u[0], u[1]);
                 });
}

Finding checkNoWo(CheckBench& bench) {
    return claim(bench, bench.file().no_wo, "no_wo", "another direction of exit", [](Query& query, unsigned index) {
        const auto u = haltonPoint(index);
        query.wo = hemisphereDirection(u[0], u[1]);
    });
}

Difference reciprocalDifference(CheckBench& bench, std::span<const Medium> media) {
    return changeOf(bench, media, [](Query& query, unsigned) {
        std::swap(query.xi, query.xo);
        std::swap(query.wi, query.wo);
        std::swap(query.ni, query.no);
    });
}

Finding checkReciprocal(CheckBench& bench) {
    if (!bench.file().reciprocal) return skipped("not claimed");
    // T12(w) = T21(w) for the angle outside, so that S is reciprocal exactly when what the model returns is.
    const Difference found = reciprocalDifference(bench, checkMedia());
    if (found.relative > bench.rounding())
        return failed(fmt::format("there and back differ by {} at {}", prettyNumber(found.relative, 2), found.where));
    return passed(found.relative == 0
                      ? "there and back are equal"
                      : fmt::format("there and back differ by {} at most", prettyNumber(found.relative, 2)));
}

}  // namespace searchlight
