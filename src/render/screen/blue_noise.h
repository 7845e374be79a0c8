// A tile of numbers that differ from their neighbours': what varies sampling from pixel to pixel.
#pragma once

#include <cstdint>
#include <vector>

namespace searchlight {

/// Side of the tile.
inline constexpr int blue_noise_side = 32;

/// Each of blue_noise_side^2 ranks once, row by row, over their number: in (0, 1), without low frequencies, seamless
/// where tiles meet. By voids and clusters [Ulichney1993]. Another seed gives another tile.
std::vector<float> blueNoise(std::uint64_t seed);

}  // namespace searchlight
