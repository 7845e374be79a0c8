// Long unabsorbed walks made rare.
#pragma once

namespace searchlight {

/// A walk without absorption has no mean length, so it lives through n collisions only with probability
/// exp(-kWhiteRoulette n), and its exit weighs the inverse. This is half of what absorption takes at the largest
/// albedo: weights then fall with n for every medium that a table answers for.
inline constexpr double kWhiteRoulette = 5e-5;

}  // namespace searchlight
