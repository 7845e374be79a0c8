// Kernels beside the ground truth: along the axis and the diagonal, and what they do to pictures.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "base/figure.h"
#include "kernel/judge.h"
#include "plot/channel.h"

namespace searchlight {

struct KernelCurve {
    std::string label;
    SeparableKernel kernel;
    Taps taps;
};

/// Density against the distance from the middle, along the axis and along the diagonal: two panels, one channel.
Figure kernelSliceFigure(const GroundTruth& truth, std::span<const KernelCurve> kernels, int channel,
                         const std::string& title);

/// What an upright edge becomes, and its difference from the ground truth: two panels, one channel.
Figure kernelEdgeFigure(const Judge& judge, std::span<const KernelCurve> kernels, int channel,
                        const std::string& title);

/// A signal (its place in signals()) before, after the ground truth, and |difference| of each kernel on one scale of
/// colours: luminance.
Figure kernelPictureFigure(const Judge& judge, std::size_t signal, const std::string& title);
Figure kernelDifferenceFigure(const Judge& judge, std::span<const KernelCurve> kernels, std::size_t signal,
                              const std::string& title);

}  // namespace searchlight
