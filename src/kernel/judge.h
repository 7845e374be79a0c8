// How far a kernel is from the ground truth: in its own space, and in pictures.
#pragma once

#include <vector>

#include "kernel/cells.h"
#include "kernel/filter.h"
#include "kernel/signals.h"

namespace searchlight {

struct JudgeOptions {
    int size = 128;      ///< of the pictures, pixels
    double side_mm = 0;  ///< of the pictures; 0: 16 times the half-energy radius of the middle channel
    CellGrid grid;       ///< of kernel space; a cell of 0: gridOf the truth
};

/// What one kernel is judged against, made once: pictures of all signals, and what the ground truth makes of them.
class Judge {
public:
    explicit Judge(const GroundTruth& truth, const JudgeOptions& options = {});

    /// Root mean square difference of each signal's picture, per channel, in the order of signals(); pictures lie
    /// within [0, 1]. Axes turn where the taps were made for it: filter().
    std::vector<Rgb> imageRms(const Taps& taps, int frames = turned_frames) const;

    /// A signal's picture through the taps; `frames` of them averaged where axes turn.
    Image filter(const Image& input, const Taps& taps, int frames = turned_frames) const;

    /// What engines average over time: 8 pictures.
    static constexpr int turned_frames = 8;

    /// The width at which the taps err least in pictures of edges, between 1/1000 and 1000: what a kernel in other
    /// units, or for another size, would have to be scaled by.
    double bestWidth(const Taps& taps) const;

    /// One number: over all signals and channels.
    static double overall(const std::vector<Rgb>& image_rms);

    /// [kernelRms]: relative to the ground truth's own root mean square.
    Rgb kernelRms(const SeparableKernel& kernel) const;

    const CellKernel& cells() const { return cells_; }
    const RadialSpectrum& spectrum() const { return spectrum_; }
    const std::vector<Image>& inputs() const { return inputs_; }
    const std::vector<Image>& exact() const { return exact_; }
    double pixel() const { return pixel_mm_; }  ///< mm

private:
    CellKernel cells_;
    double pixel_mm_;
    RadialSpectrum spectrum_;
    std::vector<Image> inputs_, exact_;
};

}  // namespace searchlight
