// A beam on plane layers by unbiased Monte Carlo: MCML's problem; oblique, wide beams and any phase function as well.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/estimate.h"
#include "base/observer.h"
#include "transport/slab/slab_tally.h"
#include "transport/walk/beam.h"
#include "transport/walk/phase_function.h"
#include "transport/walk/walk_state.h"

namespace searchlight {

namespace gl {
class Context;
}

/// One plane layer between smooth Fresnel surfaces. One that neither absorbs nor scatters is clear: glass, or a gap.
struct SlabLayer {
    double n = 1;             ///< refractive index
    double sigma_a = 0;       ///< 1/mm
    double sigma_s = 0;       ///< 1/mm, not reduced
    double g = 0;             ///< Henyey-Greenstein mean cosine, |g| < 1; not read where there is a phase
    double thickness_mm = 1;  ///< infinity in the last layer: a half-space
    std::optional<PhaseFunction> phase = {};  ///< in place of Henyey-Greenstein

    bool clear() const { return sigma_a == 0 && sigma_s == 0; }
    double meanCosine() const { return phase ? searchlight::meanCosine(*phase) : g; }
    bool operator==(const SlabLayer&) const = default;
};

/// As Estimator of the half-space.
enum class SlabEstimator {
    analogue,
    best,  ///< R, T, A follow controls (slab_control.h); R(r), T(r) and angles come from walks that foresee
           ///< (slab_best.h)
};

struct SlabProblem {
    double n_above = 1, n_below = 1;
    std::vector<SlabLayer> layers;  ///< from the top, where the beam comes from
    double angle_deg = 0;           ///< of incidence above, [0, 90); the refracted beam leans towards +x
    BeamShape beam = {};

    bool operator==(const SlabProblem&) const = default;
};

struct SlabOptions {
    std::uint64_t walks = 1'000'000;
    std::uint64_t seed = 1;
    std::vector<double> edges_mm;  ///< of the annuli about the point where the beam meets the slab; first >= 0
    int angles = 30;               ///< equal parts of 90 degrees
    int depths = 100;              ///< equal parts of depth_mm
    double depth_mm = 0;           ///< from the top of the slab
    bool maps = false;             ///< the tallies over two variables, too
    int grid = 0;                  ///< cells per side of R(x, y) and T(x, y); 0: none
    double grid_extent_mm = 0;     ///< the square is [-extent, extent]^2
    int threads = 0;               ///< 0: all
    /// On OpenGL always analogue. No walk foresees where there are grids, maps, clear layers or phase functions that
    /// are tables, nor where a pilot finds that analogue walks know R(r) as well.
    SlabEstimator estimator = SlabEstimator::analogue;
    gl::Context* gl = nullptr;  ///< walk there, counting the collisions that absorb alone; null: on the CPU
    WalkControl control;        ///< until_error: of R, T and A, those above 0
};

struct SlabSeries {
    std::vector<double> mean, standard_error;
};

/// Per unit incident flux. What was never scattered is kept apart from R, T and their series. Standard errors are those
/// of the chunks, never below that of one walk. An annulus beyond the last edge and depths beyond depth_mm are in the
/// totals alone.
struct SlabResult {
    double specular = 0;                       ///< of the beam at the top and at clear layers there: exact
    Estimate R, R_single, R_multiple;          ///< diffuse reflectance: all, scattered once, more often
    Estimate R_unscattered;                    ///< back from an interface further below, without a collision
    Estimate T, T_unscattered;                 ///< transmittance: scattered; not
    Estimate A;                                ///< absorbed
    std::vector<Estimate> A_layer;             ///< of that, in each layer
    SlabSeries R_r, R_r_single, R_r_multiple;  ///< mean over each annulus, 1/mm^2
    SlabSeries T_r;                            ///< on the lower surface, 1/mm^2
    SlabSeries R_a, T_a;                       ///< over the angle of the direction outside, 1/sr
    SlabSeries A_z;                            ///< 1/mm; from collisions, so its sum meets A within errors
    /// A_z / sigma_a, also where sigma_a is 0 (not on OpenGL); NaN in bins that are clear.
    SlabSeries fluence_z;
    /// The maps, empty unless asked for; row-major, the annulus first.
    SlabSeries R_ra, T_ra;     ///< radiance, 1/(mm^2 sr): per solid angle times cosine
    SlabSeries A_rz;           ///< 1/mm^3
    SlabSeries fluence_rz;     ///< 1/mm^2
    SlabSeries R_xy, T_xy;     ///< 1/mm^2, scattered; row-major over y then x; empty without a grid
    std::vector<double> flux;  ///< mean per slot of slabLayout, for writers that need what the series leave out
    SlabEstimator estimator = SlabEstimator::analogue;  ///< that was used
    bool foresees = false;                              ///< of the best one: other walks than analogue ones took part
    std::uint64_t walks = 0;
    std::uint64_t collisions = 0;
    double seconds = 0;  ///< wall time of walking
    int threads = 0;
    std::string instruction_set;  ///< "AVX3" (AVX-512), "AVX2", "SSE4"...; or "GL" and the device
    bool interrupted = false;     ///< fewer walks than asked for; they may be none
};

/// Where the walk counts what. Throws as walkSlab.
SlabLayout slabLayout(const SlabProblem& problem, const SlabOptions& options);

/// Walks. The result depends on problem, walks, seed and the tallies' layout alone, not on threads; AVX2 and AVX-512
/// agree bit for bit; on OpenGL it depends on the device, too. Throws an input Error for an impossible problem,
/// interruptedError() when the observer cancels.
SlabResult walkSlab(const SlabProblem& problem, const SlabOptions& options, Observer& observer);

/// Reads `{"format": "searchlight-layers/1", "n_above", "n_below", "layers": [{"n", "sigma_a", "sigma_s", "g",
/// "thickness_mm"}]}`; thickness_mm of the last layer may be "infinite"; "phase" in place of g is "rayleigh" or a table
/// (parsePhase) beside the file. Throws an input Error with file, line, column and JSON pointer.
SlabProblem parseLayers(std::string_view text, std::string_view path);

}  // namespace searchlight
