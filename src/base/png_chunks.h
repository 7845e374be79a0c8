// The pieces that a PNG file is made of, for its two writers: pictures, and figures with a palette.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace searchlight {

/// What each PNG file begins with.
inline constexpr std::string_view png_signature = "\x89PNG\r\n\x1a\n";

/// Appends the four bytes of a number, the highest first.
void appendBigEndian(std::string& bytes, std::uint32_t value);

/// Appends a chunk: its size, type and data, and the check sum of both.
void appendPngChunk(std::string& bytes, std::string_view type, std::string_view data);

}  // namespace searchlight
