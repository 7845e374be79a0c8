// How much room text takes, without asking for a font.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace searchlight {

/// Takes one character off the front of UTF-8 text; U+FFFD for a byte that does not belong. `text` is not empty.
char32_t nextCharacter(std::string_view& text);

/// Width in px, from the metrics of DejaVu Sans: wider than Helvetica and its kin, so boxes fit either.
double textWidth(std::string_view text, double font_size, bool bold = false);

/// Broken at spaces (and at line ends) into lines of at most `width` px; a longer word stands alone.
std::vector<std::string> wrapText(std::string_view text, double width, double font_size, bool bold = false);

}  // namespace searchlight
