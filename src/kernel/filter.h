// Pictures filtered: exactly, and as a shader does it.
#pragma once

#include "base/image.h"
#include "kernel/kernel.h"
#include "kernel/spectrum.h"

namespace searchlight {

struct FilterOptions {
    double pixel_mm = 1;  ///< side of a pixel on the surface
    double width = 1;     ///< scales the offsets
    /// The axes of all terms turn from pixel to pixel, turnOfPixel(): crosses become grain.
    bool turned = false;
    int frames = 1;  ///< of axes that turn: pictures with patterns of their own, averaged as engines do over time
};

/// By what the axes of a kernel turn at column x and row y, in [0, pi), so that each pass alone has all directions:
/// interleaved gradient noise [Jimenez2014], in which neighbours differ much and every 3 x 3 pixels have about all
/// angles. Another part of it for the second pass: what a pixel's neighbours did in the first one says nothing about
/// it. Frames follow each other so that a few of them meet all pairs of angles about evenly.
double turnOfPixel(double x, double y, int frame, bool second);

/// The picture, which repeats beyond its sides, convolved with the ground truth through Fourier transforms. Square, its
/// side even.
Image exactFilter(const Image& image, const RadialSpectrum& truth, double pixel_mm);

/// The passes of the taps one after another; between pixels samples are bilinear. Square, repeating like the above.
Image tapsFilter(const Image& image, const Taps& taps, const FilterOptions& options);

}  // namespace searchlight
