// Input files of MCML version 2.
#pragma once

#include <vector>

#include "transport/mcml/data_lines.h"
#include "transport/mcml/mcml_file.h"

namespace searchlight {

/// The most cells in any direction, layers and runs: MCML counts in short integers.
inline constexpr double kMostMcmlCells = 32767;

/// What follows the line `mcmli2.0`: media, then runs up to a line `end`. Throws an input Error for what a walk without
/// time cannot give: an isotropic source or one inside, categories over time, a time limit alone.
std::vector<McmlRun> parseMciVersion2(DataLines& lines);

}  // namespace searchlight
