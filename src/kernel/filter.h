// Pictures filtered: exactly, and as a shader does it.
#pragma once

#include "base/image.h"
#include "kernel/kernel.h"
#include "kernel/spectrum.h"

namespace searchlight {

struct FilterOptions {
    double pixel_mm = 1;  ///< side of a pixel on the surface
    double width = 1;     ///< scales the offsets
    /// The axes of all terms are turned from pixel to pixel, by a pattern that repeats after 4 x 4 of them: crosses
    /// become grain.
    bool turned = false;
};

/// The picture, which repeats beyond its sides, convolved with the ground truth through Fourier transforms. Square, its
/// side even.
Image exactFilter(const Image& image, const RadialSpectrum& truth, double pixel_mm);

/// The passes of the taps one after another; between pixels samples are bilinear. Square, repeating like the above.
Image tapsFilter(const Image& image, const Taps& taps, const FilterOptions& options);

}  // namespace searchlight
