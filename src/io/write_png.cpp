// PNG files by our own code over zlib: stb_image_write cannot add texts.
#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "base/error.h"
#include "base/png_chunks.h"
#include "io/image_formats.h"

namespace searchlight {

namespace {

void appendText(std::string& bytes, const std::string& key, const std::string& value) {
    if (key.empty() || key.size() > 79)
        throw usageError(fmt::format("metadata '{}' cannot go into a PNG file", key), "names have 1 to 79 letters");
    const bool ascii = std::ranges::all_of(value, [](char letter) { return static_cast<std::uint8_t>(letter) < 0x80; });
    const std::string_view flags = ascii ? std::string_view("\0", 1) : std::string_view("\0\0\0\0\0", 5);
    appendPngChunk(bytes, ascii ? "tEXt" : "iTXt", key + std::string(flags) + value);
}

// Of the byte to the left, above, and above the left, the one nearest to left + above - above_left.
int paeth(int left, int above, int above_left) {
    const int to_left = std::abs(above - above_left), to_above = std::abs(left - above_left);
    const int to_corner = std::abs(left + above - 2 * above_left);
    if (to_left <= to_above && to_left <= to_corner) return left;
    return to_above <= to_corner ? above : above_left;
}

// The row as differences by the filter that leaves the least, the standard's own heuristic.
std::string filtered(const std::string& row, const std::string& above, std::size_t pixel_bytes) {
    std::string best;
    long least = -1;
    for (int filter = 0; filter < 5; ++filter) {
        std::string candidate(1, static_cast<char>(filter));
        long sum = 0;
        for (std::size_t i = 0; i < row.size(); ++i) {
            const auto at = [&](const std::string& bytes, bool back) {
                return back && i < pixel_bytes ? 0 : static_cast<std::uint8_t>(bytes[back ? i - pixel_bytes : i]);
            };
            const int left = at(row, true), up = at(above, false), corner = at(above, true);
            const int predicted = filter == 0   ? 0
                                  : filter == 1 ? left
                                  : filter == 2 ? up
                                  : filter == 3 ? (left + up) / 2
                                                : paeth(left, up, corner);
            const auto difference = static_cast<std::int8_t>(at(row, false) - predicted);
            sum += std::abs(static_cast<int>(difference));
            candidate += static_cast<char>(difference);
        }
        if (least < 0 || sum < least) {
            least = sum;
            best = std::move(candidate);
        }
    }
    return best;
}

std::string compressed(const std::string& data) {
    uLongf size = compressBound(static_cast<uLong>(data.size()));
    std::string packed(size, '\0');
    compress2(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(data.data()),
              static_cast<uLong>(data.size()), 6);
    packed.resize(size);
    return packed;
}

}  // namespace

std::string pngBytes(const ImageFile& file, const ToneMap& tone_map) {
    const Image& image = file.image;
    const bool opaque = std::ranges::all_of(image.pixels, [](const Rgba& pixel) { return pixel.a >= 1; });
    const std::size_t pixel_bytes = opaque ? 3 : 4;
    std::string rows, above(pixel_bytes * static_cast<std::size_t>(image.width), '\0'), row;
    for (int y = 0; y < image.height; ++y) {
        row.clear();
        for (int x = 0; x < image.width; ++x) {
            const Rgba pixel = displayed(image.at(x, y), tone_map);
            const std::array<float, 4> components{pixel.r, pixel.g, pixel.b, pixel.a};
            for (std::size_t i = 0; i < pixel_bytes; ++i)
                row += static_cast<char>(static_cast<std::uint8_t>(std::lround(255 * components[i])));
        }
        rows += filtered(row, above, pixel_bytes);
        std::swap(row, above);
    }

    std::string bytes(png_signature);
    std::string header;
    appendBigEndian(header, static_cast<std::uint32_t>(image.width));
    appendBigEndian(header, static_cast<std::uint32_t>(image.height));
    header += {8, static_cast<char>(opaque ? 2 : 6), 0, 0, 0};  // bits, RGB or RGBA, and the only methods there are
    appendPngChunk(bytes, "IHDR", header);
    appendPngChunk(bytes, "sRGB", std::string_view("\1", 1));  // relative colorimetric
    for (const auto& [key, value] : file.metadata) appendText(bytes, key, value);
    // A chunk's size has 31 bits.
    const std::string data = compressed(rows);
    for (std::size_t at = 0; at < data.size(); at += std::size_t{1} << 30)
        appendPngChunk(bytes, "IDAT", std::string_view(data).substr(at, std::size_t{1} << 30));
    appendPngChunk(bytes, "IEND", {});
    return bytes;
}

}  // namespace searchlight
