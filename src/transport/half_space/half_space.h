// The searchlight problem by unbiased Monte Carlo: a beam on a half-space, one channel at a time.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/estimate.h"
#include "base/observer.h"
#include "scene/medium.h"
#include "transport/walk/beam.h"
#include "transport/walk/walk_state.h"

namespace searchlight {

namespace gl {
class Context;
}

struct HalfSpaceProblem {
    double sigma_a = 0;    ///< 1/mm
    double sigma_s = 1;    ///< 1/mm, not reduced
    double g = 0;          ///< Henyey-Greenstein mean cosine, |g| < 1
    double eta = 1;        ///< refractive index inside over outside; smooth Fresnel boundary
    double angle_deg = 0;  ///< of incidence outside, [0, 90); the refracted beam leans towards +x
    BeamShape beam = {};   ///< its axis meets the surface at the entry point
};

/// How a walk becomes a tally; both are unbiased.
enum class Estimator {
    analogue,  ///< a walk is absorbed or leaves, and counts where it leaves
    best,      ///< less noise in the same time: expected escape, importance, exact order 1 (half_space_best.h)
};

struct HalfSpaceOptions {
    std::uint64_t walks = 1'000'000;
    std::uint64_t seed = 1;
    std::vector<double> edges_mm;  ///< of the radial bins about the entry point, ascending, at least 2, first >= 0
    int grid = 0;                  ///< cells per side of the square tally R(x, y); 0: none
    double grid_extent_mm = 0;     ///< the square is [-extent, extent]^2
    /// Along x, ascending: cells of the strip about the plane of incidence; or empty.
    std::vector<double> strip_edges_mm;
    double strip_half_width_mm = 0;             ///< the strip is |y| < this
    int threads = 0;                            ///< 0: all
    Estimator estimator = Estimator::analogue;  ///< a grid, a strip or a wide beam is always walked by the analogue
    gl::Context* gl = nullptr;                  ///< walk there, by the analogue; null: on the CPU
    WalkControl control;  ///< until_error: of the total, and of the profile: the mean over its bins, weighted by flux
};

/// What left the surface after scattering, per unit incident flux.
struct HalfSpaceTally {
    Estimate total;          ///< diffuse reflectance, everything that left, also beyond the last edge
    std::vector<double> Rd;  ///< mean over each annulus, 1/mm^2, n values for n + 1 edges
    /// Of Rd, from the scatter of the chunks; never below that of one exit, so that an empty bin has a bound, not a 0.
    std::vector<double> standard_error;
    std::vector<double> beyond;  ///< one value: flux outside the edges; kept apart from the last bin
    Estimate mean_x_mm;          ///< first moment: shift of the mean exit point towards +x, of what left
    Estimate mean_r2_mm2;        ///< second moment about the entry point
    std::vector<double> grid;    ///< row-major over y then x, 1/mm^2, grid * grid values, or empty
    std::vector<double> grid_standard_error;
    std::vector<double> strip;  ///< mean over each cell of the strip, 1/mm^2, n values for n + 1 edges, or empty
    std::vector<double> strip_standard_error;
};

struct HalfSpaceResult {
    double specular = 0;                        ///< Fresnel reflectance of the beam, not part of the tallies
    HalfSpaceTally all;                         ///< every order: single + multiple
    HalfSpaceTally single;                      ///< scattered exactly once
    HalfSpaceTally multiple;                    ///< scattered twice or more
    Estimator estimator = Estimator::analogue;  ///< that was used
    std::uint64_t walks = 0;
    std::uint64_t collisions = 0;
    double seconds = 0;  ///< wall time of walking
    int threads = 0;
    std::string instruction_set;  ///< "AVX3" (AVX-512), "AVX2", "SSE4"...; or "GL" and the device
    bool interrupted = false;     ///< fewer walks than asked for; they may be none
};

/// The searchlight problem of one channel of a medium.
HalfSpaceProblem halfSpaceProblem(const Medium& medium, int channel, double angle_deg = 0);

/// Throws an input Error unless the numbers describe a problem.
void checkHalfSpaceProblem(const HalfSpaceProblem& problem);

/// Walks. The result depends on problem, walks, seed and edges alone, not on threads; AVX2 and AVX-512 agree bit for
/// bit; on OpenGL it depends on the device, too. Throws an input Error for an impossible problem, interruptedError()
/// when the observer cancels.
HalfSpaceResult walkHalfSpace(const HalfSpaceProblem& problem, const HalfSpaceOptions& options, Observer& observer);

}  // namespace searchlight
