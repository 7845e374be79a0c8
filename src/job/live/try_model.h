// Whether a text is a model that runs: what an editor asks while one types.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "base/error.h"
#include "job/engine.h"

namespace searchlight {

/// Parses, compiles and evaluates the text at a few places of a half-space of skin. The first Error, with its place in
/// `path`; none: it works. A text that is not portable is one that works. When the context was lost on the way, the
/// engine has dropped it, and the Error says so.
std::optional<Error> tryModel(std::string_view text, const std::string& path, Engine& engine);

}  // namespace searchlight
