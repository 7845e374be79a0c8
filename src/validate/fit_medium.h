// What can be fitted: a model's medium and parameters, or a normalized diffusion profile.
#pragma once

#include <string>
#include <vector>

#include "model/evaluator.h"
#include "validate/fit.h"

namespace searchlight {

struct FittedModel {
    const Model* model = nullptr;
    Evaluator* evaluator = nullptr;
    ParamValues fixed;  ///< the parameters that are not free
    double eta = 1.3;
    double g = 0;                   ///< sigma_s = sigma_sp / (1 - g)
    std::vector<std::string> free;  ///< sigma_a, sigma_sp, or number parameters of the model
};

/// What is free when nobody says: sigma_a and sigma_sp of a model that reads the medium, else every number parameter of
/// the model. May be empty.
std::vector<std::string> freeByDefault(const Model& model);

/// Values of the model at normal incidence where the data are. `fitted` outlives the curve. Throws a usage Error for a
/// name that is no number parameter with a positive range.
FitCurve modelFitCurve(const FittedModel& fitted, const FitData& data);

/// A and d of the normalized diffusion profile, [ChristensenBurley2015] Eq. 3.
FitCurve burleyFitCurve(const FitData& data);

/// Half of what the data encircle lies within, mm.
double medianRadius(const FitData& data);

}  // namespace searchlight
