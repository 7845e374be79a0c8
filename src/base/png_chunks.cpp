#include "base/png_chunks.h"

#include <zlib.h>

namespace searchlight {

void appendBigEndian(std::string& bytes, std::uint32_t value) {
    for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift & 0xff);
}

void appendPngChunk(std::string& bytes, std::string_view type, std::string_view data) {
    appendBigEndian(bytes, static_cast<std::uint32_t>(data.size()));
    const std::size_t begin = bytes.size();
    bytes += type;
    bytes += data;
    const auto* checked = reinterpret_cast<const Bytef*>(bytes.data() + begin);
    appendBigEndian(bytes, static_cast<std::uint32_t>(crc32_z(0, checked, bytes.size() - begin)));
}

}  // namespace searchlight
