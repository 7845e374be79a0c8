// Sums of models by name: "better_dipole+single" returns what its parts return, added.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/param.h"
#include "model/model.h"

namespace searchlight {

/// The parts of "better_dipole+./my.bssrdf", at least one. A path may hold '+': it ends with its ending (.bssrdf or
/// .csv), and where the whole is a file, it is that file. Throws a usage Error for an empty part.
std::vector<std::string> partNames(std::string_view name);

/// The sum of at least two models with different ids. Attributes that promise hold where they do for all parts, those
/// that say what happens where they do for one. Throws a usage Error where a part stands twice.
Model sumOf(std::vector<Model> parts);

/// The name under which the model lists the parameter that a user calls `given`. In a sum "single.ForwardPeak" is the
/// part's; ForwardPeak alone will do, and is the listed name, where one part alone has it. Other text is returned as it
/// is.
std::string parameterName(const Model& model, std::string_view given);

/// Of the parameters of a sum, those of a part, by the part's own names.
ParamValues partParameters(const Model& sum, const Model& part, const ParamValues& parameters);

/// "Single scattering is part of X and of Y: it counts twice", or empty.
std::string countedTwice(const Model& model);

}  // namespace searchlight
