// How far a picture is from its reference.
#pragma once

#include "base/image.h"

namespace searchlight {

struct ImageError {
    double rmse = 0;             ///< over R, G, B of the pixels counted
    double relative_rmse = 0;    ///< rmse over the reference's mean of R, G, B there
    double mean_difference = 0;  ///< signed, relative to that mean
    double largest = 0;          ///< absolute difference in one channel
    double ssim = 0;             ///< on perceptually uniform luminance [Wang2004, Aydin2008]
    double flip = 0;             ///< mean FLIP [Andersson2020] (LDR, sRGB, 67 pixels per degree)
    std::size_t pixels = 0;      ///< counted: those that the reference covers (alpha > 0)
};

/// Images of one size. Throws a usage Error otherwise, an input Error when the reference covers nothing.
ImageError compareImages(const Image& image, const Image& reference);

/// |image - reference| relative to the reference's mean, as false colours with alpha 1.
Image differenceImage(const Image& image, const Image& reference);

}  // namespace searchlight
