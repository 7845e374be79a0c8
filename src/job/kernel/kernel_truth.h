// Where the ground truth of a kernel comes from: the reference, a model, a measured profile.
#pragma once

#include <string>

#include "base/observer.h"
#include "job/plot/subject.h"
#include "kernel/ground_truth.h"

namespace searchlight {

struct KernelTruth {
    GroundTruth truth;
    std::string label;                               ///< "Monte Carlo, 1×10⁶ walks"
    double shortest_mfp_mm = 0, longest_mfp_mm = 0;  ///< reduced, of the channels that scatter
};

struct KernelTruthOptions {
    std::string model = "reference";  ///< or a model's id, or a measured profile
    std::string set, backend = "auto";
    std::uint64_t walks = 1'000'000;
    std::uint64_t seed = 1;
    int threads = 0;
    bool bins_of_grid =
        false;  ///< bins as wide as the cells of [Freude2014]'s rule, instead of a fraction of the radius
};

/// Tallies of walks, from tables of white walks where the albedo allows; or the table of a model. Throws an input Error
/// for a material without scattering.
KernelTruth kernelTruth(const Subject& subject, const KernelTruthOptions& options, Engine& engine, Observer& observer);

}  // namespace searchlight
