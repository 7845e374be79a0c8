// Structural similarity, [Wang2004], of luminance as it is perceived.
#pragma once

#include "base/image.h"
#include "validate/pixel_plane.h"

namespace searchlight {

/// Perceptually uniform code of a luminance, 0.005 to 10000 cd/m^2, such that an sRGB display of 100 cd/m^2 spans 0 to
/// 256: PU21 with banding and glare, [MantiukAzimi2021].
double pu21(double luminance);

/// SSIM per pixel, in [-1, 1]: a Gaussian window of 11 x 11 pixels, sigma 1.5, K1 = 0.01, K2 = 0.03; the dynamic range
/// is pu21(white). Radiance times `factor` times `white` is luminance in cd/m^2. Images of one size, finite.
PixelPlane ssimMap(const Image& image, const Image& reference, double factor, double white, int threads);

}  // namespace searchlight
