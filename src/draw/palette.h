// False colours, and pictures made of them.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace searchlight {

/// Colours of a false-colour picture: indices 0 to 253 are the scale from its lower to its upper end, then these two.
inline constexpr int scale_colors = 254;
inline constexpr std::uint8_t unknown_color = 254;      ///< grey: nothing is known
inline constexpr std::uint8_t transparent_color = 255;  ///< the paper

struct PaletteColor {
    std::uint8_t r = 0, g = 0, b = 0;
};

/// sRGB. The scale is viridis ([SmithVanDerWalt2015], by its ten published tenths, linear between them): dark to light
/// throughout, equal steps look equal, also to the colour-blind and in grey.
PaletteColor paletteColor(std::uint8_t index);

/// How many colours lines have before they begin again.
inline constexpr int series_color_count = 6;

/// "#0072B2": the colour of lines with that index into the palette, 0 or more.
std::string_view seriesColor(int index);

/// A PNG file of palette indices, row by row from the top; `indices` has width * height of them.
std::string palettePng(int width, int height, const std::vector<std::uint8_t>& indices);

}  // namespace searchlight
