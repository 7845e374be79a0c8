// Who writes State: only init() may.
#pragma once

#include <set>
#include <string_view>

#include "language/outline.h"

namespace searchlight {

/// Throws an input Error (line, column; no file) where `function`, which has a body, assigns to a name in `state` that
/// neither a parameter nor a local hides. Writes through an out argument are left to the compiler.
void checkStateWrites(const Function& function, const std::set<std::string_view>& state);

}  // namespace searchlight
