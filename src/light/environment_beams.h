// An environment as a few parallel beams, for models that have to be evaluated per direction.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/vec.h"
#include "light/environment.h"
#include "light/irradiance.h"

namespace searchlight {

struct EnvironmentBeam {
    Vec3 wi;         ///< mean direction of a region of the environment, by luminance
    Rgb irradiance;  ///< of the region, on a surface that faces wi
};

/// `count` (at least 1) regions of about equal luminance: stratified samples by importance, halved again and again
/// across their longest side, as median cut does with pixels [Debevec2005]. None for a black environment.
std::vector<EnvironmentBeam> environmentBeams(const Environment& environment, int count, std::uint64_t seed);

/// The light of one environment on points as beams, appended to `to`. The flux of `beams` is scaled, by point and
/// channel and at most twice, so that a point receives what `transmitted` (in the caller's order) says; what points
/// receive that (nearly) none of the beams reaches comes along their normals, in one more beam. None without `beams`.
void appendFitted(std::vector<Beam> beams, const LitPoints& points, std::span<const Rgbf> transmitted,
                  std::vector<Beam>& to);

}  // namespace searchlight
