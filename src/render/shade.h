// From exitance to a picture.
#pragma once

#include <span>
#include <vector>

#include "base/image.h"
#include "render/view.h"

namespace searchlight {

/// Radiance of diffuse exit: T21(wo) M / (pi 4 C_phi(1/eta)), both exact (docs/conventions.md) in single precision, per
/// sample of `visible` for as many values of M in `exitance`. Negative values, which some models give, stay negative.
/// `radiance` keeps its memory from one picture to the next.
void exitRadiance(const VisibleSurface& visible, std::span<const Rgbf> exitance, double eta, int threads,
                  std::vector<Rgbf>& radiance);

/// Stops that bring the radiance that 2 % of the object exceed to 0.8, near the white of a display; 0 for a dark
/// object.
double displayExposure(const VisibleSurface& visible, std::span<const Rgbf> radiance, int threads);

/// The samples by their coverage over `background`, which has the size of `visible` or is empty: nothing is behind.
/// `coat` is added to `radiance`; it is as long, or empty. What is negative becomes 0. `picture` keeps its memory.
void composite(const VisibleSurface& visible, std::span<const Rgbf> radiance, std::span<const Rgbf> coat,
               const Image& background, int threads, Image& picture);

}  // namespace searchlight
