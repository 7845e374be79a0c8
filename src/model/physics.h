// physics/*.glsl for C++ callers: Physics<double>::fresnelMoment(1, 1.3). Vectors are glsl::Vec (language/glsl.h).
#pragma once

#include <optional>

#include "base/error.h"
#include "language/bssrdf_file.h"
#include "native/physics.h"

namespace searchlight {

/// Why a model is outside the portable subset of GLSL (it still runs on GL), with physics/ as it ships; nothing when it
/// is inside.
std::optional<Error> portabilityError(const BssrdfFile& file);

}  // namespace searchlight
