// What a sweep leaves in its folder: a picture and its numbers per cell, and what sums them up.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "job/sweep/sweep.h"

namespace searchlight {

/// FOLDER/cell_0007.exr, or .json.
std::filesystem::path cellPath(const std::filesystem::path& folder, const SweepCell& cell, const char* ending);

/// Whether both files of the cell are there, from the same job by this version. The job's output does not matter.
bool isDone(const std::filesystem::path& folder, const SweepCell& cell);

/// Writes summary.json ("searchlight-sweep-summary/1"), summary.csv and the contact sheet from the files of the cells,
/// all of which are done, and returns their paths. Throws an input Error for a picture that cannot be read.
std::vector<std::filesystem::path> writeSummary(const Sweep& sweep, const std::filesystem::path& folder,
                                                const std::filesystem::path& sheet);

}  // namespace searchlight
