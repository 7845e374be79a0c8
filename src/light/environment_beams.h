// An environment as a few parallel beams, for models that have to be evaluated per direction.
#pragma once

#include <cstdint>
#include <vector>

#include "base/vec.h"
#include "light/environment.h"

namespace searchlight {

struct EnvironmentBeam {
    Vec3 wi;         ///< mean direction of a region of the environment, by luminance
    Rgb irradiance;  ///< of the region, on a surface that faces wi
};

/// `count` (at least 1) regions of about equal luminance: stratified samples by importance, halved again and again
/// across their longest side, as median cut does with pixels [Debevec2005]. None for a black environment.
std::vector<EnvironmentBeam> environmentBeams(const Environment& environment, int count, std::uint64_t seed);

}  // namespace searchlight
