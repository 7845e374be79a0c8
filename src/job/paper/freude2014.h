// What the tables and the figures of paper_freude2014.cpp share.
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "job/kernel/kernel_truth.h"
#include "job/paper/paper.h"

namespace searchlight::freude2014 {

/// In the order of its tables.
inline constexpr std::array<const char*, 5> material_ids{"apple", "marble", "ketchup", "skin1", "whole_milk"};

/// What is chosen in its place.
inline const std::string ground_truth =
    "R_d from walks in tables without absorption (docs/white-cache.md) instead of 10^7 photons of MCML";

/// A material's ground truth by walks; `bins_of_grid`: tallied in annuli as wide as the cells of the thesis' grid.
/// Throws what kernelTruth() throws.
KernelTruth truthOf(const std::string& material, const PaperRun& run, bool bins_of_grid);

/// Place in signals().
std::size_t signalNamed(std::string_view name);

PaperPlate figure51(const PaperRun& run);
PaperPlate figure66(const PaperRun& run);
PaperPlate figure626(const PaperRun& run);

}  // namespace searchlight::freude2014
