// The difference that a viewer sees who flips between two pictures, [Andersson2020].
#pragma once

#include "base/image.h"
#include "validate/pixel_plane.h"

namespace searchlight {

/// FLIP for low dynamic range, per pixel, in [0, 1]. Radiance times `factor` is clamped to [0, 1], the range of an sRGB
/// display. Images of one size, finite.
PixelPlane flipMap(const Image& image, const Image& reference, double factor, double pixels_per_degree, int threads);

}  // namespace searchlight
