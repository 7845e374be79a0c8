// Pictures of models beside their reference: errors without the share of noise, and the sheet that shows them.
#pragma once

#include <string>
#include <vector>

#include "base/image.h"
#include "draw/contact_sheet.h"
#include "job/json.h"

namespace searchlight {

/// A picture, and an error per pixel and channel whose mean square is that of its noise; empty: it has none.
struct NoisyImage {
    Image mean, error;
};

/// What is relative is so to the reference's mean over R, G, B.
struct NoisyError {
    double rmse = 0;   ///< relative, of R, G, B and pixels, noise included
    double noise = 0;  ///< relative: the RMSE that two pictures of one expectation would have
    double bias = 0;   ///< sqrt(rmse^2 - noise^2), 0 where noise is all there is
    double mean = 0;   ///< relative, signed
    double ssim = 0;   ///< of perceptually uniform luminance, noise included
};

/// `exposure`: stops, for SSIM.
NoisyError noisyError(const NoisyImage& image, const NoisyImage& reference, double exposure, int threads);

Json noisyErrorJson(const NoisyError& error);

/// Joins a picture to the right of another, of one height; to an empty one, it is that picture.
void appendRight(Image& left, const Image& right);
void appendRight(NoisyImage& left, const NoisyImage& right);

/// Cells of a sheet.
SheetCell pictureCell(const Image& image, double exposure, std::string note);
/// Luminance less the reference's: blue too dark, orange too bright, full at `full_scale` of the reference's mean.
SheetCell differenceCell(const Image& image, const Image& reference, double full_scale, std::string note);
/// The square of the difference of each channel, full at the square of `full_scale` times the reference's mean.
SheetCell squareCell(const Image& image, const Image& reference, double full_scale, std::string note);

}  // namespace searchlight
