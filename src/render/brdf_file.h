// The .brdf format of Disney's BRDF Explorer [Burley2012]: a reflectance as text.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/param.h"

namespace searchlight {

struct BrdfFile {
    std::string path;  ///< for messages
    std::vector<Param> parameters;
    std::string shader;  ///< GLSL with vec3 BRDF(vec3 L, vec3 V, vec3 N, vec3 X, vec3 Y), as it stands in the file
    int shader_first_line = 0;  ///< 1-based line of the file on which `shader` starts
};

/// Parses the text of a .brdf file: a first line "analytic", sections parameters (float, bool, color) and shader;
/// sections of other names are passed over. Throws an input Error with file, line and column.
BrdfFile parseBrdf(std::string_view text, std::string_view path);

/// A value for each of the file's parameters, in their order: from `given`, which are as a scene has them, else the
/// default. Throws a usage Error for a value that does not fit, and for a name that the file does not have, with the
/// nearest.
std::vector<ParamValue> brdfValues(const BrdfFile& file, const ParamValues& given);

}  // namespace searchlight
