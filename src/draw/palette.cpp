#include "draw/palette.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <string_view>

#include "base/png_chunks.h"

namespace searchlight {

namespace {

constexpr std::array<std::uint32_t, 10> viridis{0x440154, 0x482878, 0x3e4989, 0x31688e, 0x26828e,
                                                0x1f9e89, 0x35b779, 0x6ece58, 0xb5de2b, 0xfde725};

// Okabe and Ito's palette without yellow, which white paper swallows: safe for the colour-blind, and neighbours differ
// in lightness as long as there are few.
constexpr std::array<std::string_view, series_color_count> series_colors{"#0072B2", "#E69F00", "#009E73",
                                                                         "#D55E00", "#CC79A7", "#56B4E9"};

}  // namespace

std::string_view seriesColor(int index) {
    return series_colors[static_cast<std::size_t>(index) % series_colors.size()];
}

PaletteColor paletteColor(std::uint8_t index) {
    if (index == unknown_color) return {200, 200, 200};
    if (index == transparent_color) return {255, 255, 255};
    const double at = static_cast<double>(index) / (scale_colors - 1) * (viridis.size() - 1);
    const std::size_t i = std::min(static_cast<std::size_t>(at), viridis.size() - 2);
    const double t = at - static_cast<double>(i);
    const auto mixed = [&](int shift) {
        const double a = viridis[i] >> shift & 0xff, b = viridis[i + 1] >> shift & 0xff;
        return static_cast<std::uint8_t>(std::lround(a + t * (b - a)));
    };
    return {mixed(16), mixed(8), mixed(0)};
}

std::string palettePng(int width, int height, const std::vector<std::uint8_t>& indices) {
    assert(indices.size() == static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    std::string rows;
    for (std::size_t y = 0; y < static_cast<std::size_t>(height); ++y) {
        rows += '\0';  // no filter: indices are not a signal
        rows.append(reinterpret_cast<const char*>(indices.data()) + y * static_cast<std::size_t>(width),
                    static_cast<std::size_t>(width));
    }
    uLongf size = compressBound(static_cast<uLong>(rows.size()));
    std::string packed(size, '\0');
    compress2(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(rows.data()),
              static_cast<uLong>(rows.size()), 9);
    packed.resize(size);

    std::string header, colors, opacities;
    appendBigEndian(header, static_cast<std::uint32_t>(width));
    appendBigEndian(header, static_cast<std::uint32_t>(height));
    header += {8, 3, 0, 0, 0};  // bits, palette, and the only methods there are
    for (int i = 0; i < 256; ++i) {
        const PaletteColor color = paletteColor(static_cast<std::uint8_t>(i));
        for (const std::uint8_t c : {color.r, color.g, color.b}) colors += static_cast<char>(c);
        opacities += static_cast<char>(i == transparent_color ? 0 : 255);
    }
    std::string bytes(png_signature);
    appendPngChunk(bytes, "IHDR", header);
    appendPngChunk(bytes, "PLTE", colors);
    appendPngChunk(bytes, "tRNS", opacities);
    appendPngChunk(bytes, "IDAT", packed);
    appendPngChunk(bytes, "IEND", {});
    return bytes;
}

}  // namespace searchlight
