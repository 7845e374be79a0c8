// Who writes State: only init() may.
#pragma once

#include <map>
#include <set>
#include <string_view>
#include <vector>

#include "language/outline.h"

namespace searchlight {

/// Of each function with out or inout parameters, which of its parameters they are.
using OutParameters = std::map<std::string_view, std::vector<bool>>;

/// Adds the functions of `outline`; overloads of one name are taken together.
void collectOutParameters(const Outline& outline, OutParameters& into);

/// Throws an input Error (line, column; no file) where `function`, which has a body, assigns to a name in `state` that
/// neither a parameter nor a local hides, or hands it to one of the `out_parameters`.
void checkStateWrites(const Function& function, const std::set<std::string_view>& state,
                      const OutParameters& out_parameters);

}  // namespace searchlight
