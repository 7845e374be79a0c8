// What probes find around receivers.
#pragma once

#include <cstdint>
#include <vector>

#include "base/observer.h"
#include "geometry/rays.h"
#include "render/direct/even_points.h"
#include "render/direct/probes.h"
#include "render/view.h"

namespace searchlight {

/// A surface point that a probe found, within its reach.
struct ProbeHit {
    std::uint32_t receiver = 0;
    double weight = 0;  ///< one over the expected number of samples per mm^2 that a receiver's probes have there
};

/// Of receivers in a row: hits in their order, and the points that were hit.
struct ProbeHits {
    std::vector<ProbeHit> hits;
    ChosenPoints points;
    std::vector<SurfacePlace> places;  ///< of the points
};

/// `per_receiver` stratified probes for each of receivers [begin, end) of `visible`. The outcome does not depend on
/// `threads`. Throws interruptedError() when cancelled.
ProbeHits findHits(const Probes& probes, const VisibleSurface& visible, std::size_t begin, std::size_t end,
                   int per_receiver, std::uint64_t seed, const RayScene& rays, const SurfaceWalk& walk, int threads,
                   const Observer& observer);

}  // namespace searchlight
