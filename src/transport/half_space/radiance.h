// The radiance that leaves a point of a half-space under a pencil beam, by unbiased Monte Carlo.
#pragma once

#include <vector>

#include "base/estimate.h"
#include "transport/half_space/half_space.h"

namespace searchlight {

struct RadianceOptions {
    std::uint64_t walks = 1'000'000;
    std::uint64_t seed = 1;
    double r0_mm = 0, r1_mm = 1;  ///< of the annulus about the entry point that the point is widened to
    double azimuth_deg = 0;       ///< of its middle, counted from +x, the side that the refracted beam leans to
    double half_width_deg = 10;   ///< of the sector, up to 180: the whole annulus
    int polar = 9;                ///< cells of the polar angle: equal steps from 0 to 90 degrees
    int turns = 24;               ///< cells of the azimuth: equal steps from +x towards +y
    int threads = 0;              ///< 0: all
};

/// Per unit incident flux, after scattering. Cell (i, j) of the hemisphere outside is [i * turns + j].
struct RadianceResult {
    double specular = 0;  ///< Fresnel reflectance of the beam, not part of the rest
    Estimate exitance;    ///< mean over the sector of what leaves into all directions, 1/mm^2
    /// Mean over the sector and, weighted by the cosine, over each cell, 1/(mm^2 sr).
    std::vector<double> radiance;
    std::vector<double> standard_error;  ///< from the scatter of the chunks; at least that of one exit
    std::uint64_t walks = 0;
    double seconds = 0;
};

/// Walks; which are those of walkHalfSpace() with the same seed. Throws an input Error for an impossible problem or
/// sector, interruptedError() when the observer cancels.
RadianceResult walkRadiance(const HalfSpaceProblem& problem, const RadianceOptions& options, Observer& observer);

}  // namespace searchlight
