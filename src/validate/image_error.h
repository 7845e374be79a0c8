// How far a picture is from its reference.
#pragma once

#include "base/image.h"

namespace searchlight {

struct ImageError {
    double rmse = 0;             ///< over R, G, B of the pixels counted
    double relative_rmse = 0;    ///< rmse over the reference's mean of R, G, B there
    double mean_difference = 0;  ///< signed, relative to that mean: above 0 where the picture is too bright
    double largest = 0;          ///< absolute difference in one channel
    double ssim = 0;             ///< on perceptually uniform luminance [Wang2004, MantiukAzimi2021]
    double flip = 0;             ///< mean FLIP [Andersson2020] (LDR, sRGB, 67 pixels per degree)
    std::size_t pixels = 0;      ///< counted: those that the reference covers (alpha > 0)
};

struct ImageErrorOptions {
    double exposure = 0;  ///< stops, on both pictures, for ssim and flip: what a viewer sees at 1 is full white
    double white = 100;   ///< luminance of that white, cd/m^2, for ssim
    double pixels_per_degree = 67.0206;  ///< for flip: 3840 pixels over 0.7 m, seen from 0.7 m
    bool perceptual = true;              ///< ssim and flip too, which take longest; else they are 0
    int threads = 0;
};

/// Images of one size; what is premultiplied stands before black. Throws a usage Error otherwise, an input Error when
/// the reference covers nothing, is black there, or a value of either is infinite or not a number.
ImageError compareImages(const Image& image, const Image& reference, const ImageErrorOptions& options = {});

struct DifferenceOptions {
    double full_scale = 1;   ///< the difference at the end of the scale, in multiples of the reference's mean
    bool is_signed = false;  ///< of luminance: blue where the picture is too dark, orange where it is too bright
};

/// The difference relative to the reference's mean, as false colours with alpha 1, in linear light: code values of a
/// PNG without tone mapping are the colours meant. Unsigned: the largest |image - reference| of R, G, B, on a scale
/// whose lightness rises evenly from black to white [Green2011]. Signed: as DifferenceOptions say, from black at no
/// difference. Throws as compareImages.
Image differenceImage(const Image& image, const Image& reference, const DifferenceOptions& options = {});

}  // namespace searchlight
