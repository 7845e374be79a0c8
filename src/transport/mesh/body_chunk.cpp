#include <algorithm>
#include <bit>

#include "transport/mesh/body_walk.h"

namespace searchlight {

std::int32_t waysFor(std::uint64_t walks) {
    // Beyond 4,096 what walks share is lost among what they do not; below 64 lanes would be idle.
    return static_cast<std::int32_t>(std::bit_floor(std::clamp(walks / 16, std::uint64_t{64}, std::uint64_t{4096})));
}

std::vector<double> BodyChunk::pack() const {
    const auto number = [](std::uint64_t count) { return static_cast<double>(count); };
    std::vector<double> values{entry.arrived,
                               entry.entered,
                               number(entry.arrivals),
                               number(entry.walks),
                               number(candidates),
                               number(collisions),
                               number(flights),
                               number(rays),
                               number(taken_back),
                               number(lost),
                               left,
                               absorbed,
                               exits.x,
                               exits.y,
                               exits.z};
    for (const CellExit& exit : cells) values.insert(values.end(), {number(exit.cell), exit.weight});
    return values;
}

void BodyChunk::unpack(std::span<const double> values) {
    const double* next = values.data();
    const auto count = [&](std::uint64_t& value) { value = static_cast<std::uint64_t>(*next++); };
    entry.arrived = *next++, entry.entered = *next++;
    count(entry.arrivals), count(entry.walks), count(candidates), count(collisions), count(flights), count(rays);
    count(taken_back), count(lost);
    left = *next++, absorbed = *next++;
    exits = {next[0], next[1], next[2]};
    cells.clear();
    for (next += 3; next != values.data() + values.size(); next += 2)
        cells.push_back({static_cast<std::uint32_t>(next[0]), static_cast<float>(next[1])});
}

}  // namespace searchlight
