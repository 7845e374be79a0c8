// The methods by name, with what each of them can be told.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "kernel/gaussians.h"
#include "kernel/guided.h"
#include "kernel/manual.h"
#include "kernel/skin_model.h"

namespace searchlight {

struct Method {
    std::string_view name;   ///< "svd"
    std::string_view shows;  ///< one line
};

/// In the order of tables.
std::span<const Method> methods();

struct MethodOptions {
    std::string method = "preintegrated";
    int taps = 17;         ///< per pass: odd, 3 to 101
    bool placed = false;   ///< offsets where they serve best, instead of quadratic ones
    double rest = 0.01;    ///< of quadratic offsets: part of a line beyond the outermost, tapExtent
    int rank = 1;          ///< svd: 1 and more; optimised: 1 or 2
    GuidedOptions guided;  ///< guided
    int count = 4;         ///< gaussians: terms
    GaussianMeasure measure = GaussianMeasure::pictures;
    std::string preset;  ///< gaussians: a set of gaussianPresets; manual: of twoGaussiansPresets; empty: a fit
    std::optional<TwoGaussians> manual;
    std::optional<SkinModel> skin;  ///< absent: fitted
};

/// A kernel as lines, as taps, or both.
struct MadeKernel {
    std::string name;                       ///< "svd 3"
    std::optional<SeparableKernel> kernel;  ///< absent where taps are all there is
    std::optional<SeparableKernel> raw;     ///< before it was normalised, where that changed it
    Taps taps;
    std::optional<SkinModel> skin;

    std::size_t rank() const { return taps.rank(); }
};

/// Makes it. `cells` are the truth in kernel space. Without preset and numbers, `manual` is the radial fit of
/// two Gaussians on one line. Throws a usage Error for an unknown name and for numbers that make no sense.
MadeKernel makeKernel(const GroundTruth& truth, const CellKernel& cells, const MethodOptions& options);

/// The radial fit's two Gaussians on one line, with one weight for all channels: where a hand would begin.
TwoGaussians fittedTwoGaussians(const GroundTruth& truth);

/// Lines that the taps stand for: each weight spread evenly over its cell, as sampleTaps gathered it.
SeparableKernel kernelOfTaps(const Taps& taps);

}  // namespace searchlight
