// Portable float maps: a text header, then floats, rows from the bottom.
#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>

#include "base/error.h"
#include "base/text.h"
#include "io/image_formats.h"

namespace searchlight {

namespace {

bool isBlank(char letter) { return letter == ' ' || letter == '\n' || letter == '\r' || letter == '\t'; }

// The word at `at`, which moves behind it and the one blank after it.
std::string_view nextWord(std::string_view bytes, std::size_t& at) {
    while (at < bytes.size() && isBlank(bytes[at])) ++at;
    const std::size_t begin = at;
    // No number of a header is longer than 40 letters.
    while (at < bytes.size() && at - begin < 40 && !isBlank(bytes[at])) ++at;
    const std::string_view word = bytes.substr(begin, at - begin);
    if (at < bytes.size()) ++at;
    return word;
}

double numberOf(std::string_view bytes, std::size_t& at, std::string_view what) {
    const std::string_view word = nextWord(bytes, at);
    const std::optional<double> value = parseNumber(word);
    if (!value || (what != "scale" && *value != std::floor(*value)))
        throw inputError(fmt::format("'{}' is no {}", word, what),
                         "expected 'PF', width, height, scale, and the floats");
    return *value;
}

float floatAt(const char* at, bool swapped) {
    std::uint32_t bits;
    std::memcpy(&bits, at, sizeof bits);
    return std::bit_cast<float>(swapped ? __builtin_bswap32(bits) : bits);
}

}  // namespace

ImageFile parsePfm(std::string_view bytes) {
    std::size_t at = 0;
    const std::string_view magic = nextWord(bytes, at);
    if (magic != "PF" && magic != "Pf")
        throw inputError("is no portable float map", "expected 'PF' or 'Pf' at its start");
    const std::size_t components = magic == "PF" ? 3 : 1;
    const double width = numberOf(bytes, at, "width"), height = numberOf(bytes, at, "height");
    const double scale = numberOf(bytes, at, "scale");
    if (scale == 0) throw inputError("the scale is 0", "expected -1 for little-endian floats, 1 for big-endian ones");
    const std::size_t pixel_bytes = components * sizeof(float);
    checkSize(width, height, static_cast<double>(bytes.size() - at), 1.0 / static_cast<double>(pixel_bytes));

    Image image(static_cast<int>(width), static_cast<int>(height));
    const bool swapped = (scale < 0) != (std::endian::native == std::endian::little);
    const char* from = bytes.data() + at;
    for (int y = image.height - 1; y >= 0; --y) {
        for (int x = 0; x < image.width; ++x, from += pixel_bytes) {
            Rgba& pixel = image.at(x, y);
            pixel.r = floatAt(from, swapped);
            pixel.g = components == 3 ? floatAt(from + 4, swapped) : pixel.r;
            pixel.b = components == 3 ? floatAt(from + 8, swapped) : pixel.r;
            pixel.a = 1;
        }
    }
    return {std::move(image), {}, {}};
}

std::string pfmBytes(const Image& image) {
    const bool little = std::endian::native == std::endian::little;
    std::string bytes = fmt::format("PF\n{} {}\n{}\n", image.width, image.height, little ? "-1.0" : "1.0");
    for (int y = image.height - 1; y >= 0; --y)
        for (int x = 0; x < image.width; ++x)
            bytes.append(reinterpret_cast<const char*>(&image.at(x, y)), 3 * sizeof(float));
    return bytes;
}

}  // namespace searchlight
