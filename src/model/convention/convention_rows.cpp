#include "model/convention/convention_rows.h"

#include <algorithm>

namespace searchlight::convention {

ConventionKey color(std::string name, std::string meaning) {
    return {{.name = std::move(name), .type = ParamType::channels, .min = 0, .max = 1, .required = true},
            std::move(meaning)};
}

ConventionKey lengths(std::string name, std::string unit, std::string meaning) {
    return {{.name = std::move(name),
             .type = ParamType::channels,
             .unit = std::move(unit),
             .min = 0,
             .max = unlimited,
             .required = true,
             .exclusive = true},
            std::move(meaning)};
}

ConventionKey number(std::string name, double value, double min, double max, std::string meaning, std::string unit) {
    return {{.name = std::move(name), .unit = std::move(unit), .min = min, .max = max, .value = value},
            std::move(meaning)};
}

ConventionKey eta(std::string name) {
    return number(std::move(name), 1.3, .25, 4, "refractive index, inside over outside");
}

double one(const ConventionValues& values, std::string_view key) { return values.find(key)->second.front(); }

double at(const ConventionValues& values, std::string_view key, int channel) {
    const std::vector<double>& list = values.find(key)->second;
    return list.size() == 1 ? list.front() : list[static_cast<std::size_t>(channel)];
}

int channelsOf(const ConventionValues& values) {
    return std::ranges::all_of(values, [](const auto& entry) { return entry.second.size() == 1; }) ? 1 : Rgb::channels;
}

Medium reducedMedium(const Medium& medium) {
    Medium reduced = medium;
    reduced.sigma_s = medium.sigmaSp();
    reduced.g = {};
    return reduced;
}

Medium withOneG(const Medium& medium, double min, double max, std::vector<std::string>& notes) {
    const Rgb& g = medium.g;
    const bool same = medium.channels == 1 || (g.r == g.g && g.g == g.b);
    if (same && g.r >= min && g.r <= max) return medium;
    notes.push_back(
        same ? fmt::format("g {} is outside {} to {}: the reduced medium, sigma_s' with g 0, is written", g.r, min, max)
             : "g differs between channels and the convention has one: the reduced medium, sigma_s' with "
               "g 0, is written");
    return reducedMedium(medium);
}

double largest(const std::vector<double>& list) {
    double found = 0;
    for (const double value : list)
        if (std::isfinite(value)) found = std::max(found, value);
    return found > 0 ? found : nan;
}

std::vector<double> over(const std::vector<double>& list, double divisor) {
    std::vector<double> quotients;
    for (const double value : list) quotients.push_back(value / divisor);
    return quotients;
}

void noteMissing(const Medium& medium, const std::vector<double>& list, std::string_view reason,
                 std::vector<std::string>& notes) {
    for (int c = 0; c < medium.channels; ++c)
        if (medium.scatters(c) && std::isnan(list[static_cast<std::size_t>(c)]))
            notes.push_back(medium.channels == 1 ? std::string(reason) : fmt::format("{}: {}", "RGB"[c], reason));
}

}  // namespace searchlight::convention
