// One reader and one writer per picture format, from bytes and into bytes. Internal to this folder: the door is
// image_file.h.
#pragma once

#include <string>
#include <string_view>

#include "io/image_file.h"

namespace searchlight {

/// The most pixels that a picture may have, all layers together: 16384 x 8192, four times over.
constexpr double max_pixels = 4. * 16384 * 8192;

/// Before the keys of metadata among the attributes of an EXR file, some of whose own names ("version", "type") have a
/// fixed meaning.
constexpr std::string_view exr_metadata = "searchlight.";

/// Throws an input Error unless a picture of that size may be held, and `bytes`, the file's size, can be its
/// compressed form: no more than `pixels_per_byte` pixels come out of a byte.
void checkSize(double width, double height, double bytes, double pixels_per_byte);

/// `text` with '?' for what cannot be printed.
std::string printable(std::string_view text);

/// Throws an input Error, without file, for an attribute whose value is longer than the file or has another size than
/// its type.
void checkExrHeaders(std::string_view bytes);

// Each parse... throws an input Error without file. Metadata and layers are those that the format can hold.

ImageFile parseExr(std::string_view bytes);
ImageFile parseHdr(std::string_view bytes);
ImageFile parsePfm(std::string_view bytes);
ImageFile parsePng(std::string_view bytes);

std::string exrBytes(const ImageFile& file);
std::string hdrBytes(const Image& image);
std::string pfmBytes(const Image& image);
std::string pngBytes(const ImageFile& file, const ToneMap& tone_map);

}  // namespace searchlight
