// What plots and the report stand on: the reference walks of a medium, and every model on the same bins.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "job/plot/subject.h"
#include "plot/albedo.h"
#include "plot/pencil.h"
#include "transport/half_space/half_space.h"
#include "transport/white/white_cache.h"

namespace searchlight {

/// One walk per channel that scatters.
struct ReferenceRun {
    Medium medium;
    double angle_deg = 0;
    std::vector<double> edges_mm;
    std::array<std::optional<HalfSpaceResult>, Rgb::channels> channels;
    std::array<std::optional<CachedWhiteTable>, Rgb::channels> white;  ///< where the channels came from tables

    bool interrupted = false;  ///< walks are missing; channels that were not reached are absent

    std::uint64_t walks() const;
    double seconds() const;
    /// Per unit incident flux; channels that do not scatter are NaN.
    PencilReference curve() const;
};

struct ReferenceOptions {
    std::uint64_t walks = 1'000'000;  ///< per channel
    std::uint64_t seed = 1;
    double angle_deg = 0;
    std::vector<double> edges_mm;  ///< empty: chosen from the medium
    int grid = 0;
    double grid_extent_mm = 0;
    int threads = 0;
    Estimator estimator = Estimator::best;
    gl::Context* gl = nullptr;  ///< walk there, by the analogue
    BeamShape beam;             ///< a wide one is walked by the analogue
    bool white = false;         ///< from tables of walks without absorption, in the user's cache; no grid, no estimator
    bool exact = false;         ///< solved without walks, where whyNotExact() or whyNotOrdinates() is empty
    bool only[Rgb::channels] = {true, true, true};    ///< channels to walk
    std::function<WalkControl(int channel)> control;  ///< of the walks; may be empty
    std::vector<double> strip_edges_mm;               ///< cells of the strip about the plane of incidence; empty: none
    double strip_half_width_mm = 0;
};

ReferenceRun runReference(const Medium& medium, const ReferenceOptions& options, Observer& observer);

/// Loads the comma-separated `models` of the job's options ("all": every shipped one of a half-space) for the subject's
/// medium.
std::vector<LoadedModel> loadModels(const std::vector<std::string>& names, std::string_view backend,
                                    const Subject& subject, Engine& engine);

/// Title and settings: "Better dipole, Moments exact".
std::string modelLabel(const LoadedModel& loaded);

/// The model per unit incident flux: at `radii_mm`, and averaged over the reference's annuli where there are any.
PencilCurve modelCurve(LoadedModel& loaded, double angle_deg, const std::vector<double>& radii_mm,
                       const std::vector<double>& edges_mm);

/// Edges of `bins` annuli up to r_max (0: chosen from the medium), growing quadratically so that the steep part near
/// the beam is resolved.
std::vector<double> plotEdges(const Medium& medium, double r_max_mm, int bins);

/// `count` radii from 3e-5 r_max, which no axis tells from 0, to r_max, logarithmic, for smooth curves.
std::vector<double> curveRadii(double r_max_mm, int count = 384);

struct AlbedoData {
    std::vector<AlbedoCurve> models;
    std::optional<AlbedoReference> reference;
};

/// Total diffuse reflectance per unit incident flux over the reduced albedo, at normal incidence; `walks` per point of
/// the reference, 0: none. Isotropic scattering under a matched boundary has an exact reference, which costs no walks.
AlbedoData albedoData(double eta, double g, const std::vector<std::string>& models, std::uint64_t walks,
                      std::uint64_t seed, std::string_view backend, Engine& engine, Observer& observer);

}  // namespace searchlight
