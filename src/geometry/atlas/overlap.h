// Whether triangles in the plane lie over one another.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>

#include "geometry/atlas/flatten.h"

namespace searchlight {

using FlatTriangle = std::array<Vec2, 3>;

/// Two triangles whose insides meet by more than `slack` (in the plane's unit) in every direction, the first that are
/// found; none where all lie beside one another. Triangles that share a side or a corner do not overlap.
std::optional<std::pair<std::uint32_t, std::uint32_t>> overlaps(std::span<const FlatTriangle> triangles, double slack);

}  // namespace searchlight
