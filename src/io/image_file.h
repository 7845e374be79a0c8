// Pictures from files, and into them. One file per format beside this one, a table in image_file.cpp.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/image.h"

namespace searchlight {

/// Reads .exr (half, float; RGB, RGBA, Y; further layers by their names), .hdr (RGBE), .pfm, .png (8 or 16 bits, sRGB
/// decoded to linear). Throws an input Error that says what is wrong with the file and what is valid.
ImageFile readImage(const std::string& path);

/// The same for bytes in memory: `path` gives the ending, and the name in messages.
ImageFile parseImage(std::string_view bytes, const std::string& path);

/// How linear radiance becomes 8-bit sRGB. Never applied to .exr, .hdr and .pfm.
struct ToneMap {
    double exposure = 0;  ///< stops: radiance times 2^exposure
    enum class Curve { srgb, filmic } curve = Curve::srgb;
    double gamma = 1;  ///< on top of sRGB: value^(1/gamma)
};

/// One pixel for display: premultiplied radiance to straight sRGB code values in [0, 1]; alpha stays. NaN is black.
Rgba displayed(Rgba pixel, const ToneMap& tone_map);

/// Writes .exr (float, layers, metadata), .hdr, .pfm (image alone), .png (8-bit sRGB by `tone_map`, straight alpha,
/// metadata as text chunks). Written aside and renamed. Throws a usage Error for another ending or an empty picture.
void writeImage(const std::string& path, const ImageFile& file, const ToneMap& tone_map = {});

/// The bytes that writeImage() would write there. Throws as it does.
std::string imageBytes(const std::string& path, const ImageFile& file, const ToneMap& tone_map = {});

/// Endings that can be read and written, with the dot: for file dialogs and hints.
std::vector<std::string> imageEndings();

}  // namespace searchlight
