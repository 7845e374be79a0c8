// How far models are from the reference: kinds of error side by side, and over the albedo.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "base/estimate.h"
#include "base/figure.h"

namespace searchlight {

/// One model's errors, relative: 0.1 is drawn as 10 %.
struct ModelErrors {
    std::string label;
    std::vector<Estimate> errors;  ///< one per kind; what is not finite is left out
};

/// A dot per model and kind of error, with bars of two standard errors. Throws an input Error when a model has another
/// number of errors than there are kinds.
Figure modelErrorsFigure(std::span<const ModelErrors> models, const std::vector<std::string>& kinds,
                         const std::string& title);

/// Of one model over many media.
struct ErrorsOverAlbedo {
    std::string label;
    std::vector<double> albedo, error;  ///< reduced albedo alpha', relative error; any order
};

/// A dot per model and medium, over 1 - alpha'.
Figure errorsOverAlbedoFigure(std::span<const ErrorsOverAlbedo> models, const std::string& title);

}  // namespace searchlight
