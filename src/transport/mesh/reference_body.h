// The exitance reference: what light that enters a closed body leaves on each cell of its surface, unbiased for the
// means over cells. Geometric normals, opaque shadow rays; the first exit ends a walk.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/estimate.h"
#include "base/observer.h"
#include "scene/medium.h"
#include "transport/mesh/closed_body.h"
#include "transport/mesh/entry.h"
#include "transport/walk/walk_state.h"

namespace searchlight {

namespace gl {
class Context;
}

struct BodyOptions {
    std::uint64_t walks = 1'000'000;  ///< light paths that reach the surface, about: they are drawn
    std::uint64_t seed = 1;
    int threads = 0;            ///< 0: all
    bool large_steps = true;    ///< false: each collision is walked, to check with
    gl::Context* gl = nullptr;  ///< walk there, in a ball; null: on the CPU
    WalkControl control;
};

/// One channel. Flux is in mm^2 times the unit of irradiance.
struct BodyResult {
    Estimate incident;     ///< flux that reached the surface
    Estimate entered;      ///< of it, what crossed
    Estimate left;         ///< came out
    Estimate reflectance;  ///< left over incident
    Estimate absorbed;     ///< over incident
    Estimate collisions_per_entry;
    Estimate mean_exit[3];                    ///< x, y, z where flux left, mm
    std::vector<double> exitance;             ///< per cell: flux that left per mm^2, before T21
    std::vector<double> standard_error;       ///< of it; never below that of one exit
    double largest_weight = 0;                ///< of the walks that the roulette was set by, over the mean
    std::uint64_t arrivals = 0, entries = 0;  ///< walks
    std::uint64_t candidates = 0;             ///< points and directions tried; the estimates are means over them
    std::uint64_t collisions = 0, flights = 0, rays = 0;
    std::uint64_t taken_back = 0;  ///< times that a walk that rounding led out was put back inside
    std::uint64_t lost = 0;        ///< walks that could not be put back
    double seconds = 0;            ///< wall time of walking
    int threads = 0;
    bool interrupted = false;  ///< walks are missing
};

/// Walks one channel of a medium. The result does not depend on threads. Throws an input Error when nothing is lit, the
/// channel does not scatter, or more than one walk in 1e4 is put back or lost (the mesh crosses itself);
/// interruptedError() when the observer cancels and the control has no state.
BodyResult walkBody(const Ball& body, const Medium& medium, int channel, const Illumination& light,
                    const BodyOptions& options, Observer& observer);
BodyResult walkBody(const MeshBody& body, const Medium& medium, int channel, const Illumination& light,
                    const BodyOptions& options, Observer& observer);

}  // namespace searchlight
