// What a kernel does to each spatial frequency. The transform of a picture times it is the transform of the result, so
// that errors of pictures can be found, and made small, without pictures.
#pragma once

#include <array>
#include <vector>

#include "kernel/ground_truth.h"
#include "kernel/kernel.h"

namespace searchlight {

/// The ground truth's transform, radial like itself: that of its line, by the projection-slice theorem. Tabulated.
class RadialSpectrum {
public:
    /// From `lowest` up to `highest`, 1/mm. Outside: 1 below, 0 above.
    RadialSpectrum(const std::array<LineKernel, Rgb::channels>& lines, double lowest, double highest);

    Rgb operator()(double omega) const;

private:
    double first_ = 0, per_octave_ = 0;
    std::vector<Rgb> values_;
};

/// Transform of one term's taps along its line; `width` scales the offsets.
double tapsTransform(const TapTerm& term, int channel, double omega, double width = 1);

/// Transform of all terms at (x, y), 1/mm.
Rgb tapsTransform(const Taps& taps, double omega_x, double omega_y, double width = 1);

}  // namespace searchlight
