// Long walks made rare, not cut.
#pragma once

#include <cmath>
#include <cstdint>

#include "base/random.h"

namespace searchlight {

/// Walks of more collisions meet an extra roulette. Without absorption the length of a walk has no mean; with it, the
/// roulette is out of reach: at albedo 0.999 one walk in 1e58 gets here.
inline constexpr std::int32_t kLongWalk = 1 << 17;

/// Here the roulette turns steep, so that counters never overflow.
inline constexpr std::int32_t kEndlessWalk = 1 << 30;

/// Weight of a walk that lives after n collisions: 1 up to kLongWalk, then n / kLongWalk, tenfold each beyond
/// kEndlessWalk. [Bitterli2013] section 3.2 has the tenfold roulette alone; weights that grow with n keep the expected
/// time finite and the largest contribution of a walk as small as its rarity allows (a walk without absorption reaches
/// n with probability ~ n^-1/2).
inline double longWalkWeight(std::int32_t n) {
    if (n <= kLongWalk) return 1;
    if (n <= kEndlessWalk) return static_cast<double>(n) / kLongWalk;
    return std::pow(10.0, n - kEndlessWalk) * kEndlessWalk / kLongWalk;
}

/// Draws how many collisions a long walk survives: at least n with probability 1 / longWalkWeight(n).
inline std::int32_t longWalkSurvives(SplitMix64& random) {
    const double n = kLongWalk / random.uniform();
    if (n < kEndlessWalk) return static_cast<std::int32_t>(n);
    return kEndlessWalk + static_cast<std::int32_t>(-std::log10(random.uniform()));
}

}  // namespace searchlight
