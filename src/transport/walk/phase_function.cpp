#include "transport/walk/phase_function.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "base/csv.h"
#include "base/error.h"

namespace searchlight {

namespace {

constexpr std::size_t kMostSamples = 100'000;

// 1 - cos without the cancellation of that.
double versine(double angle_deg) {
    const double sine = std::sin(0.5 * angle_deg * (std::numbers::pi / 180));
    return 2 * sine * sine;
}

// Weight of the bins between the samples.
std::vector<double> binWeights(const PhaseFunction& phase) {
    std::vector<double> weights;
    for (std::size_t i = 0; i + 1 < phase.values.size(); ++i)
        weights.push_back(0.5 * (phase.values[i] + phase.values[i + 1]) *
                          (versine(phase.angles_deg[i + 1]) - versine(phase.angles_deg[i])));
    return weights;
}

}  // namespace

double meanCosine(const PhaseFunction& phase) {
    const std::vector<double> weights = binWeights(phase);
    double total = 0, first = 0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        if (weights[i] == 0) continue;
        const double m0 = versine(phase.angles_deg[i]), width = versine(phase.angles_deg[i + 1]) - m0;
        const double p0 = phase.values[i], p1 = phase.values[i + 1];
        total += weights[i];
        first += weights[i] * (m0 + width * (p0 + 2 * p1) / (3 * (p0 + p1)));
    }
    return 1 - first / total;
}

PhaseFunction rayleighPhase() {
    constexpr int bins = 512;
    PhaseFunction phase;
    for (int i = 0; i <= bins; ++i) {
        const double cosine = 1 - 2.0 * i / bins;
        phase.angles_deg.push_back(i == bins ? 180 : std::acos(cosine) * (180 / std::numbers::pi));
        phase.values.push_back(3 / (16 * std::numbers::pi) * (1 + cosine * cosine));
    }
    return phase;
}

PhaseFunction parsePhase(std::string_view text, std::string_view path) {
    const CsvTable table = parseCsv(text, path);
    if (table.header.size() != 2 || table.header[0].text != "angle_deg" || table.header[1].text != "p")
        throw inputError("unexpected columns", "a phase function has the columns angle_deg, p")
            .at(path, table.header.empty() ? 1 : table.header[0].line);
    if (table.rows.size() < 2 || table.rows.size() > kMostSamples)
        throw inputError(fmt::format("the table has {} rows", table.rows.size()), "2 to 100000 angles from 0 to 180")
            .at(path);
    PhaseFunction phase;
    bool any = false;
    for (std::size_t row = 0; row < table.rows.size(); ++row) {
        const auto at = [&](std::size_t column) -> const CsvCell& { return table.rows[row][column]; };
        const double angle = table.number(row, 0), value = table.number(row, 1);
        const bool last = row + 1 == table.rows.size();
        if (row == 0 ? angle != 0 : angle <= phase.angles_deg.back() || (last ? angle != 180 : angle >= 180))
            throw inputError(fmt::format("angle {} is out of order", at(0).text),
                             "angles ascend from 0 in the first row to 180 in the last")
                .at(path, at(0).line, at(0).column);
        if (value < 0 || value > 1e30)
            throw inputError(fmt::format("p is {}", at(1).text), "0 to 1e30").at(path, at(1).line, at(1).column);
        any = any || value > 0;
        phase.angles_deg.push_back(angle);
        phase.values.push_back(value);
    }
    if (!any) throw inputError("the phase function is 0 everywhere", "some p above 0").at(path);
    return phase;
}

PhaseTables::Range PhaseTables::add(const PhaseFunction& phase) {
    const std::vector<double> weights = binWeights(phase);
    const std::size_t count = weights.size();
    const Range range{static_cast<std::int32_t>(stay.size()), static_cast<std::int32_t>(count)};
    double total = 0;
    for (const double weight : weights) total += weight;

    // Bins that have less than the mean are filled up from those that have more.
    std::vector<double> part;
    std::vector<std::size_t> poor, rich;
    for (std::size_t i = 0; i < count; ++i) {
        part.push_back(weights[i] / total * static_cast<double>(count));
        (part[i] < 1 ? poor : rich).push_back(i);
    }
    std::vector<std::size_t> other(count);
    for (std::size_t i = 0; i < count; ++i) other[i] = i;
    while (!poor.empty() && !rich.empty()) {
        const std::size_t to = poor.back(), from = rich.back();
        poor.pop_back();
        other[to] = from;
        part[from] -= 1 - part[to];
        if (part[from] >= 1) continue;
        rich.pop_back();
        poor.push_back(from);
    }
    for (const std::size_t i : poor) part[i] = 1;  // up to rounding

    for (std::size_t i = 0; i < count; ++i) {
        const double m0 = versine(phase.angles_deg[i]), m1 = versine(phase.angles_deg[i + 1]);
        const double sum = phase.values[i] + phase.values[i + 1];
        stay.push_back(static_cast<std::int32_t>(std::round(kStays * std::min(part[i], 1.0))));
        alias.push_back(range.first + static_cast<std::int32_t>(other[i]));
        begin.push_back(static_cast<float>(m0));
        width.push_back(static_cast<float>(m1 - m0));
        density.push_back(sum > 0 ? static_cast<float>(2 * phase.values[i] / sum) : 1.0f);
    }
    return range;
}

}  // namespace searchlight
