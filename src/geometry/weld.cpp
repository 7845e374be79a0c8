#include "geometry/weld.h"

#include <bit>

namespace searchlight {

namespace {

// Adding 0 makes -0 and 0 the same bits.
std::uint64_t hashOf(Vec3f p) {
    std::uint64_t hash = 0xCBF29CE484222325u;
    for (const float x : {p.x, p.y, p.z})
        hash = (hash ^ std::bit_cast<std::uint32_t>(x + 0.0f)) * 0x9E3779B97F4A7C15u, hash ^= hash >> 29;
    return hash;
}

}  // namespace

Weld weldPositions(std::span<const Vec3f> positions) {
    constexpr std::uint32_t none = ~std::uint32_t{0};
    // Open addressing at half load.
    const std::size_t slots = std::bit_ceil(2 * positions.size() + 1);
    std::vector<std::uint32_t> table(slots, none);
    Weld weld;
    weld.of.resize(positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i) {
        std::size_t slot = hashOf(positions[i]) & (slots - 1);
        while (table[slot] != none && !(positions[table[slot]] == positions[i])) slot = (slot + 1) & (slots - 1);
        if (table[slot] == none) {
            table[slot] = static_cast<std::uint32_t>(i);
            weld.of[i] = weld.count++;
        } else {
            weld.of[i] = weld.of[table[slot]];
        }
    }
    return weld;
}

}  // namespace searchlight
