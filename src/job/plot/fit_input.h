// What a fit is made to: files of profiles.
#pragma once

#include <string>

#include "validate/profile_data.h"

namespace searchlight {

/// Reads a .csv table, or the JSON that `reference halfspace` and `profile` write (channels that do not scatter are
/// refused). `order` is "all", or "single" or "multiple" for that part of a reference's light. Throws an input Error.
ProfileData readFitInput(const std::string& path, const std::string& order);

}  // namespace searchlight
