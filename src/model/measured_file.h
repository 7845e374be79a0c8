// Measured radial profiles: a CSV table of R_d over r (docs/conventions.md says which columns and metadata).
#pragma once

#include <string_view>

#include "model/model.h"

namespace searchlight {

/// Parses "r_mm, R, G, B" or "r_mm, R_d" in mm and 1/mm^2, with "# per: transmitted" (the default) or "# per:
/// incident", which needs "# eta: N" and is divided by T12 at normal incidence; "# title: ..." is optional. The model
/// has no id. Throws an input Error with file, line and column.
Model parseMeasured(std::string_view text, std::string_view path);

}  // namespace searchlight
