// Radii by importance, for lanes: annuli that a density gives the same probability.
#pragma once

#include <vector>

#include "model/profile.h"

namespace searchlight {

/// 2,048 annuli of equal probability under `density` (its first channel; nowhere negative, somewhere positive), from
/// the middle outwards: of each the square of its inner radius and its width in that, mm^2.
std::vector<float> equalAnnuli(const Profile& density);

}  // namespace searchlight
