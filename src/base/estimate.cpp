#include "base/estimate.h"

#include <cassert>
#include <cmath>
#include <limits>

namespace searchlight {

Estimate estimateFromBatches(std::span<const double> sums, std::span<const std::uint64_t> counts) {
    assert(sums.size() == counts.size());
    double sum = 0;
    std::uint64_t count = 0;
    for (std::size_t b = 0; b < sums.size(); ++b) {
        sum += sums[b];
        count += counts[b];
    }
    if (count == 0) return {};
    const double n = static_cast<double>(count);
    const double mean = sum / n;
    if (sums.size() < 2) return {mean, std::numeric_limits<double>::infinity(), count};
    // Variance of a ratio of batch sums: residuals against the common mean, [Cochran1977] section 2.11.
    double residuals = 0;
    for (std::size_t b = 0; b < sums.size(); ++b) {
        const double residual = sums[b] - mean * static_cast<double>(counts[b]);
        residuals += residual * residual;
    }
    const double batches = static_cast<double>(sums.size());
    return {mean, std::sqrt(residuals * batches / (batches - 1)) / n, count};
}

}  // namespace searchlight
