// What a model does over a grid of media, in numbers: for the table of docs/model-sanity.md.
#pragma once

#include <string>
#include <vector>

#include "validate/check.h"

namespace searchlight {

/// One point of the grid, reduced extinction 1/mm.
struct SanityTotal {
    double eta = 1, g = 0, albedo = 0;  ///< albedo: reduced
    double angle_deg = 0;
    double total = 0;  ///< of what entered
};

struct ModelSanity {
    std::vector<SanityTotal> totals;  ///< normal incidence, over the whole grid
    std::vector<SanityTotal> above;   ///< every point and angle at which more leaves than has entered
    SanityTotal most;                 ///< the largest total

    double least_share = 0;  ///< LeastValue::share; 0: nowhere negative
    std::string least_where;

    double reciprocal = 0;  ///< largest difference with both ends exchanged, relative to the largest value there
    std::string reciprocal_where;

    bool scales = false;  ///< false: it does not read the medium, or a length has no room to be scaled
    double scaling = 0;   ///< largest relative error of R_d(s r; sigma / s) s^2 = R_d(r; sigma)
    std::string scaling_where;
};

/// Reduced albedos of the grid, 0.02 to 0.9999; with IOR 0.77, 1, 1.3, 1.5 and g 0, 0.5, 0.9.
const std::vector<double>& sanityAlbedos();

/// Throws what checkModel throws. Natively where there is such an evaluator, else on GL.
ModelSanity modelSanity(const Model& model, const ParamValues& parameters, const EvaluatorFactory& factory,
                        Observer& observer);

}  // namespace searchlight
