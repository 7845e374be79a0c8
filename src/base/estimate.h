// Every Monte Carlo number carries its uncertainty.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace searchlight {

struct Estimate {
    double mean = 0;
    double standard_error = 0;
    std::uint64_t count = 0;  ///< samples behind the mean; 0: an exact number
};

/// Mean and standard error from independent batches: `sums[b]` is the sum over `counts[b]` samples.
/// Batches may differ in size; fewer than two give an infinite standard error.
Estimate estimateFromBatches(std::span<const double> sums, std::span<const std::uint64_t> counts);

}  // namespace searchlight
