// From what artists know, total diffuse reflectance Rdr and diffuse mean free path ld, to sigma_a and sigma_s'.
#pragma once

#include <vector>

#include "model/evaluator.h"

namespace searchlight {

struct InversionTarget {
    Rgb Rdr;    ///< total diffuse reflectance per unit transmitted flux
    Rgb ld_mm;  ///< diffuse mean free path 1/sigma_tr, mm
    double eta = 1.3;
    double g = 0;
    int channels = 3;
};

struct Inversion {
    Medium medium;  ///< sigma_s is not reduced: sigma_sp / (1 - g)
    Rgb alpha_prime;
    Rgb achieved;                      ///< the model's Rdr at that albedo
    std::vector<bool> reached;         ///< per channel; false: the model cannot reach the target, the nearest is given
    Rgb reachable_min, reachable_max;  ///< of Rdr over alpha' in [0, 1]
    bool from_profile = false;         ///< no DiffuseReflectance: the profile's own integral was inverted
    std::string mean_free_path;        ///< which D defines ld: "classical" or "grosjean"
};

/// Inverts any model: through its DiffuseReflectance where it has one, else through totalRd. Throws an input Error for
/// targets outside (0, 1] or ld <= 0.
Inversion invert(Evaluator& evaluator, const Model& model, const ParamValues& parameters,
                 const InversionTarget& target);

/// The target that inverts to this medium: its Rdr by the model, and ld with the model's D. Channels that do not
/// scatter, or do not absorb, have the nearest that an inversion takes. g is the mean of the channels, which a target
/// has one of.
InversionTarget inversionTarget(Evaluator& evaluator, const Model& model, const ParamValues& parameters,
                                const Medium& medium);

}  // namespace searchlight
