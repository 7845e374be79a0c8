#include "draw/text_width.h"

#include <array>
#include <cstdint>

#include "base/text.h"

namespace searchlight {

namespace {

// Advance widths of DejaVu Sans 2.37 in 1/1000 em, U+0020 to U+007E.
constexpr std::array<std::uint16_t, 95> advance{
    318, 401, 460, 838, 636, 950, 780, 275, 390, 390, 500, 838, 318, 361,  318, 337, 636, 636, 636,
    636, 636, 636, 636, 636, 636, 636, 337, 337, 838, 838, 838, 531, 1000, 684, 686, 698, 770, 632,
    575, 775, 752, 295, 295, 656, 557, 863, 748, 787, 603, 787, 695, 635,  611, 732, 684, 989, 685,
    611, 685, 390, 337, 390, 838, 500, 500, 613, 635, 550, 635, 615, 352,  635, 634, 278, 278, 579,
    278, 974, 634, 612, 635, 635, 411, 521, 392, 634, 592, 818, 592, 592,  525, 636, 337, 636, 838};

constexpr double bold_factor = 1.12;  // bold over regular, mean over lower-case text

}  // namespace

char32_t nextCharacter(std::string_view& text) {
    const auto byte = [&](size_t i) { return static_cast<unsigned char>(text[i]); };
    const unsigned char lead = byte(0);
    const size_t length = lead < 0x80 ? 1 : lead >> 5 == 6 ? 2 : lead >> 4 == 14 ? 3 : lead >> 3 == 30 ? 4 : 0;
    char32_t code = length == 1 ? lead : lead & (0x7F >> length);
    bool valid = length > 0 && length <= text.size();
    for (size_t i = 1; valid && i < length; ++i) {
        valid = byte(i) >> 6 == 2;
        code = code << 6 | (byte(i) & 0x3F);
    }
    constexpr std::array<char32_t, 5> smallest{0, 0, 0x80, 0x800, 0x10000};
    valid = valid && code >= smallest[length] && code <= 0x10FFFF && (code < 0xD800 || code > 0xDFFF);
    text.remove_prefix(valid ? length : 1);
    return valid ? code : U'\uFFFD';
}

double textWidth(std::string_view text, double font_size, bool bold) {
    double width = 0;
    while (!text.empty()) {
        const char32_t code = nextCharacter(text);
        if (code >= 0x20 && code < 0x7F)
            width += advance[code - 0x20];
        else if (code == U'²' || code == U'³' || code == U'·' || code == U'′')
            width += 380;
        else if (code < 0x2E80)
            width += 700;  // Greek, Cyrillic, operators: a generous mean
        else
            width += 1000;  // full-width scripts
    }
    return width * font_size / 1000 * (bold ? bold_factor : 1);
}

std::vector<std::string> wrapText(std::string_view text, double width, double font_size, bool bold) {
    std::vector<std::string> lines;
    for (const std::string_view paragraph : split(text, '\n')) {
        std::string line;
        for (const std::string_view word : split(paragraph, ' ')) {
            if (word.empty()) continue;
            const std::string longer = line.empty() ? std::string(word) : line + ' ' + std::string(word);
            if (!line.empty() && textWidth(longer, font_size, bold) > width) {
                lines.push_back(std::move(line));
                line = word;
            } else {
                line = longer;
            }
        }
        if (!line.empty()) lines.push_back(std::move(line));
    }
    return lines;
}

}  // namespace searchlight
