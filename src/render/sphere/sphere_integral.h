// What a model says leaves a lit sphere, by Monte Carlo: the same quantity, over the same cells, as the walks of
// transport/mesh count.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/estimate.h"
#include "base/observer.h"
#include "light/transmitted_cosine.h"
#include "model/evaluator.h"
#include "render/sphere/chord_sampler.h"
#include "render/sphere/surface_light.h"
#include "transport/mesh/closed_body.h"

namespace searchlight {

/// M per cell of a sphere: flux that leaves per mm^2, before T21, with its standard error. Channels that do not scatter
/// are empty.
struct SphereExitance {
    std::array<std::vector<double>, Rgb::channels> mean, standard_error;
};

struct SphereIntegralOptions {
    std::vector<std::uint32_t> cells;  ///< to be integrated; empty: all
    std::uint64_t seed = 1;
    int threads = 0;  ///< 0: all
};

/// Progressive: the mean over each cell of
///   M(xo) = integral over the sphere and all directions of light of R_d(xi, wi; xo) T12(wi) cos dE,
/// for a model that reads wo with directions drawn as light leaves, T21 cos / (pi 4 C_phi(1/eta)), which is R_d
/// (docs/conventions.md). Geometry is the reference's: xi and xo on the sphere, its own normals, distances straight
/// through it. Each sample of a cell is a pair of entries, one drawn by the model's profile around xo (ChordSampler),
/// one where light falls (SurfaceLight), combined by the balance heuristic [Veach1995]: close to the receiver the first
/// is the better one, in the dark the second. Unbiased for the model; the profile only decides where it is evaluated.
class SphereIntegral {
public:
    /// `evaluator` is set to the medium; all but `medium` outlive this. Throws what tabulate() throws.
    SphereIntegral(const Ball& ball, const LightSampler& lights, const Model& model, Evaluator& evaluator,
                   const Medium& medium, SphereIntegralOptions options);

    /// `samples` more of every cell. The sums do not depend on threads, nor on how calls are cut. Throws
    /// interruptedError() when cancelled (whole samples of the cells so far stay counted), an input Error when the
    /// model returns what is not finite.
    void add(int samples, Observer& observer);

    /// Of the cell that has fewest.
    std::uint64_t samples() const { return samples_; }

    /// Cells that are not integrated are 0; with fewer than two samples the standard error is infinite.
    SphereExitance exitance() const;

    /// Flux that leaves the cells, mm^2 times the unit of irradiance.
    std::array<Estimate, Rgb::channels> left() const;

private:
    struct Sums {
        Rgb value, square;
    };

    void addTo(std::size_t first, std::size_t count);
    Estimate estimateOf(std::size_t i, int channel) const;

    const Ball& ball_;
    const LightSampler& lights_;
    const Model& model_;
    Evaluator& evaluator_;
    Medium medium_;
    SphereIntegralOptions options_;
    SurfaceLight light_;
    ChordSampler chords_;
    TransmittedCosine transmitted_;
    std::vector<Sums> sums_;  ///< per entry of options_.cells
    std::uint64_t samples_ = 0;
    std::size_t done_ = 0;  ///< cells that already have the sample under way, after an interruption
    std::vector<Query> queries_;
    std::vector<Rgb> values_, weights_;
};

}  // namespace searchlight
