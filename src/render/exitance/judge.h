// How wrong a sum is, by what a sample of its receivers says.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "render/exitance_sum.h"

namespace searchlight {

/// Leaves in a sample. The spread of the squared error between leaves makes 64 of them know its mean to about 20 %.
inline constexpr std::size_t sampled_leaves = 64;

/// A leaf of receivers that was drawn.
struct DrawnLeaf {
    std::uint32_t first, count;  ///< receivers, in the order of the tree
    double weight;               ///< 1 / (probability x number of draws)
};

/// A fixed sequence, so that a sample is the same each time.
std::uint32_t scrambled(std::uint32_t v);

/// The upper confidence limit of one channel's relative RMSE. Raises the bound of the largest error in `result` by what
/// the channel says. `peak`: largest exitance, roughly; `receivers`: of which the leaves were drawn.
double judge(std::span<const DrawnLeaf> sample, std::span<const float> tried, std::span<const float> truth, double peak,
             std::size_t receivers, SumCalibration& result);

}  // namespace searchlight
