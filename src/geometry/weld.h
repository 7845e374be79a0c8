// Vertices that stand at one position: what a seam of uvs or a crease cut apart.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/vec.h"

namespace searchlight {

struct Weld {
    std::vector<std::uint32_t> of;  ///< per position: its number among those that differ, in order of first appearance
    std::uint32_t count = 0;        ///< positions that differ
};

/// Positions are one when all three floats are equal (0 and -0 are).
Weld weldPositions(std::span<const Vec3f> positions);

}  // namespace searchlight
