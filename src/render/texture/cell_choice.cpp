#include "render/texture/cell_choice.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "base/random.h"

namespace searchlight {

SampleNumbers sampleNumbers(std::size_t k, std::size_t n, std::uint64_t seed) {
    SplitMix64 random = streamOf(seed, 0x7e57);
    const double along = random.uniform(), across = random.uniform(), around = random.uniform();
    // Powers of 1 / 1.3247..., the root of x^3 = x + 1 [Roberts2018].
    constexpr double first = 0.7548776662466927, second = 0.5698402909980532;
    const auto i = static_cast<double>(k);
    const auto wrapped = [](double x) { return x - std::floor(x); };
    return {(i + along) / static_cast<double>(n), wrapped(across + i * first), wrapped(around + i * second)};
}

CellChooser::CellChooser(std::span<const double> weights) {
    until_.reserve(weights.size());
    double sum = 0;
    for (const double weight : weights) until_.push_back(sum += weight);
    assert(sum > 0);
}

CellChoice CellChooser::choose(double along) const {
    const double wanted = along * total();
    // The first whose sum exceeds what is wanted: its weight is above 0. Rounding may lead beyond the last one.
    auto found = std::ranges::upper_bound(until_, wanted);
    if (found == until_.end()) found = std::ranges::lower_bound(until_, total());
    const double before = found == until_.begin() ? 0 : *(found - 1);
    const double weight = *found - before;
    return {static_cast<std::uint32_t>(found - until_.begin()),
            std::clamp((wanted - before) / weight, 0.0, 1 - 0x1p-53), weight / total()};
}

std::vector<CellChoice> CellChooser::choose(std::span<const double> along) const {
    std::vector<CellChoice> choices;
    for (const double each : along) choices.push_back(choose(each));
    return choices;
}

}  // namespace searchlight
