// Pictures from files, and into them. One file per format beside this one, a table in image_file.cpp.
#pragma once

#include <string>
#include <string_view>

#include "base/image.h"

namespace searchlight {

/// Reads .exr (half, float; RGB, RGBA, Y; further layers by their names), .hdr (RGBE), .pfm, .png (8 or 16 bits, sRGB
/// decoded to linear). Throws an input Error that says what is wrong with the file and what is valid.
ImageFile readImage(const std::string& path);
ImageFile parseImage(std::string_view bytes, const std::string& path);

/// How linear radiance becomes 8-bit sRGB. Never applied to .exr, .hdr and .pfm.
struct ToneMap {
    double exposure = 0;  ///< stops: radiance times 2^exposure
    enum class Curve { srgb, filmic } curve = Curve::srgb;
    double gamma = 1;  ///< on top of sRGB: value^(1/gamma)
};

/// One pixel for display: premultiplied radiance to sRGB code values in [0, 1]; alpha stays.
Rgba displayed(Rgba pixel, const ToneMap& tone_map);

/// Writes .exr (float, layers, metadata), .hdr, .pfm (image alone), .png (8-bit sRGB by `tone_map`, straight alpha,
/// metadata as text chunks). Written aside and renamed. Throws a usage Error for another ending.
void writeImage(const std::string& path, const ImageFile& file, const ToneMap& tone_map = {});

}  // namespace searchlight
