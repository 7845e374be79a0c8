// Sums of Gaussians that come nearest to a profile.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "validate/fit.h"

namespace searchlight {

constexpr int most_gaussians = 6;

struct GaussianFitOptions {
    int count = 4;  ///< 1 to most_gaussians
    FitWeight weight = FitWeight::relative;
    std::vector<double> total;  ///< of each channel: what its weights add to; empty: free
};

/// Sum over k of weight exp(-r^2 / 2v) / (2 pi v). All channels share the variances, as in [dEonLuebke2007].
struct GaussianFit {
    std::vector<double> variance_mm2, variance_error;       ///< ascending
    std::vector<std::vector<double>> weight, weight_error;  ///< [channel][k], not negative; a weight of 0 has no error
    std::vector<FitResiduals> residuals;                    ///< per channel
    double reduced_chi2 = 0;
    double condition = 0;
    std::vector<std::string> warnings;
    int evaluations = 0;
};

/// Variances by search over their logarithms, weights by non-negative least squares for each of them (variable
/// projection, [GolubPereyra1973]), then Gauss and Newton on both. `data` hold the channels, at the same radii. Throws
/// a usage Error for a count outside the range, an input Error for too few data, and interruptedError().
GaussianFit fitGaussians(std::span<const FitData> data, const GaussianFitOptions& options, Observer& observer);

/// The Gaussian's mean over the data's annulus, or its value at their point.
double gaussianValue(const FitData& data, std::size_t i, double variance_mm2);

}  // namespace searchlight
