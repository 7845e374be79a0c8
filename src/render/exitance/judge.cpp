#include "render/exitance/judge.h"

#include <algorithm>
#include <cmath>

#include "render/exitance/receiver_tree.h"

namespace searchlight {

namespace {

// Standard errors that the bound lies above what the sample has.
constexpr double confidence = 3;
// And what it is multiplied by: rare leaves that a sample of this size misses.
constexpr double missed = 1.1;

}  // namespace

std::uint32_t scrambled(std::uint32_t v) {
    v = (v ^ v >> 16) * 0x7feb352d;
    v = (v ^ v >> 15) * 0x846ca68b;
    return v ^ v >> 16;
}

double judge(std::span<const DrawnLeaf> sample, std::span<const float> tried, std::span<const float> truth, double peak,
             std::size_t receivers, SumCalibration& result) {
    double error = 0, norm = 0, represented = 0;
    std::vector<double> errors, norms, largest, local;
    for (const DrawnLeaf& leaf : sample) {
        double e = 0, m = 0, worst = 0;
        for (std::size_t i = leaf.first; i < leaf.first + leaf.count; ++i) {
            const double off = static_cast<double>(tried[i]) - static_cast<double>(truth[i]);
            e += off * off;
            worst = std::max(worst, std::abs(off));
            m += static_cast<double>(truth[i]) * static_cast<double>(truth[i]);
        }
        errors.push_back(e * leaf.weight);
        norms.push_back(m * leaf.weight);
        largest.push_back(worst);
        local.push_back(std::sqrt(m / leaf.count));
        error += errors.back();
        norm += norms.back();
        represented += leaf.weight * leaf.count;
    }
    if (!(norm > 0)) return 0;
    // Ratio of two sums over the same draws, [Cochran1977] Eq. 6.13.
    const double ratio = error / norm;
    double variance = 0;
    for (std::size_t k = 0; k < errors.size(); ++k) {
        const double off = errors[k] - ratio * norms[k];
        variance += off * off;
    }
    variance *= static_cast<double>(sample.size()) / static_cast<double>(sample.size() - 1);

    const double rms = std::sqrt(norm / represented);
    const double bound = missed * std::sqrt(ratio + confidence * std::sqrt(variance) / norm);
    // Where the light is concentrated the error is, too, and the sample may have missed the brightest leaf. And of
    // 1e5 normal deviates the largest is above 4; these are not normal, and 14 was seen.
    double relative = 0;
    for (std::size_t k = 0; k < largest.size(); ++k)
        relative = std::max(relative, largest[k] / std::max(local[k], rms));
    // The largest error of a leaf has an exponential tail: what lies above the sample's upper quarter, on average,
    // is gained with every factor e in the number of leaves, and four times more for chance.
    std::sort(largest.begin(), largest.end());
    const std::size_t upper = largest.size() * 3 / 4;
    double excess = 0;
    for (std::size_t k = upper; k < largest.size(); ++k) excess += largest[k] - largest[upper];
    excess /= static_cast<double>(largest.size() - upper);
    const double leaves = static_cast<double>(receivers) / ReceiverTree::Impl::leaf_size;
    const double extreme = largest[upper] + excess * (std::log(std::max(4.0, leaves) / 4) + 4);
    result.largest_error_bound = std::max(
        {result.largest_error_bound, extreme / rms, 2 * largest.back() / rms, 1.5 * relative * peak / rms, 16 * bound});
    return bound;
}

}  // namespace searchlight
