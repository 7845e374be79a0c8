// Sums of Gaussians: the one kernel that is separable and radial at once ([dEonLuebke2007], [Freude2014] Eq. 4.4).
#pragma once

#include <span>
#include <string_view>

#include "kernel/ground_truth.h"
#include "kernel/kernel.h"

namespace searchlight {

inline constexpr int most_gaussian_terms = 6;

/// Where a fit is near: in pictures, the power of whose edges falls as the third power of the frequency, or in kernel
/// space, as the papers have it: with a mass of 1, or with any and divided by it afterwards.
enum class GaussianMeasure { pictures, kernel_space, kernel_space_any_mass };

/// Sum over `weights` of 1-D Gaussians, normalised to the weights; a variance of 0 is the delta. Ends at 6 sigma of the
/// widest. As many of both, variances in mm^2.
LineKernel gaussianLine(std::span<const double> weights, std::span<const double> variances_mm2);

/// `count` terms (1 to most_gaussian_terms), each a Gaussian whose variance and weight differ between channels; weights
/// are positive and add up to 1. `cell_mm` > 0: radii below it are one cell of kernel space.
SeparableKernel fittedGaussians(const GroundTruth& truth, int count, GaussianMeasure measure, double cell_mm);

/// A published sum, one term for each variance; its weights are divided by their sum.
struct GaussianPreset {
    std::string_view name;  ///< "skin6"
    std::string_view source;
    std::span<const double> variances_mm2;
    std::span<const Rgb> weights;
};

std::span<const GaussianPreset> gaussianPresets();

/// Throws a usage Error with the valid names.
SeparableKernel presetGaussians(std::string_view name);

}  // namespace searchlight
