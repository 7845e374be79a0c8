// The headers of an OpenEXR file, walked before OpenEXR sees them: it takes memory for what an attribute says it holds
// before it looks whether the file holds it.
#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <optional>

#include "base/error.h"
#include "io/image_formats.h"

namespace searchlight {

namespace {

// Bytes of a value, of the types that have a fixed size.
struct Fixed {
    std::string_view type;
    std::uint32_t size;
};
constexpr std::array<Fixed, 24> fixed_sizes{{{"box2f", 16},
                                             {"box2i", 16},
                                             {"chromaticities", 32},
                                             {"compression", 1},
                                             {"deepImageState", 1},
                                             {"double", 8},
                                             {"envmap", 1},
                                             {"float", 4},
                                             {"int", 4},
                                             {"keycode", 28},
                                             {"lineOrder", 1},
                                             {"m33f", 36},
                                             {"m33d", 72},
                                             {"m44f", 64},
                                             {"m44d", 128},
                                             {"rational", 8},
                                             {"tiledesc", 9},
                                             {"timecode", 8},
                                             {"v2f", 8},
                                             {"v2i", 8},
                                             {"v2d", 16},
                                             {"v3f", 12},
                                             {"v3i", 12},
                                             {"v3d", 24}}};

std::uint32_t littleEndian(std::string_view bytes, std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = 4; i-- > 0;) value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
    return value;
}

// Whether a value of `type` is as long as its bytes.
bool isWhole(std::string_view type, std::string_view value) {
    for (const Fixed& fixed : fixed_sizes)
        if (fixed.type == type) return value.size() == fixed.size;
    if (type == "chlist") {  // name, 0, 16 bytes; at the end a 0
        std::size_t at = 0;
        while (at < value.size() && value[at] != '\0') {
            const std::size_t end = value.find('\0', at);
            if (end == std::string_view::npos || value.size() - end < 1 + 16) return false;
            at = end + 1 + 16;
        }
        return at + 1 == value.size();
    }
    if (type == "preview") {  // width, height, 4 bytes a pixel
        if (value.size() < 8) return false;
        const std::uint64_t width = littleEndian(value, 0), height = littleEndian(value, 4);
        return width <= value.size() && height <= value.size() && 8 + 4 * width * height == value.size();
    }
    if (type == "stringvector") {  // length and text, repeated
        std::size_t at = 0;
        while (value.size() - at >= 4) {
            const std::uint32_t length = littleEndian(value, at);
            if (length > value.size() - at - 4) return false;
            at += 4 + length;
        }
        return at == value.size();
    }
    return true;
}

}  // namespace

void checkExrHeaders(std::string_view bytes) {
    const auto cut_off = [&] {
        return inputError(fmt::format("the file ends at byte {}, in its header", bytes.size()));
    };
    std::size_t at = 8;
    const auto word = [&] {
        const std::size_t end = bytes.find('\0', std::min(at, bytes.size()));
        if (end == std::string_view::npos) throw cut_off();
        const std::string_view text = bytes.substr(at, end - at);
        if (text.size() > 255)
            throw inputError(fmt::format("byte {}: a name of {} letters", at, text.size()), "expected at most 255");
        at = end + 1;
        return text;
    };
    if (bytes.size() < at) throw cut_off();
    const bool parts = (static_cast<unsigned char>(bytes[5]) & 0x10) != 0;
    for (bool first = true;; first = false) {
        // A header ends with an empty name; where there are parts, an empty header ends the list.
        std::size_t attributes = 0;
        for (std::string_view name = word(); !name.empty(); name = word(), ++attributes) {
            const std::string_view type = word();
            if (bytes.size() - at < 4) throw cut_off();
            const std::uint32_t size = littleEndian(bytes, at);
            at += 4;
            if (size > bytes.size() - at)
                throw inputError(fmt::format("byte {}: an attribute of {} bytes", at - 4, size),
                                 fmt::format("the file has {} more", bytes.size() - at));
            if (!isWhole(type, bytes.substr(at, size)))
                throw inputError(fmt::format("byte {}: {} bytes are no {}", at - 4, size, printable(type)));
            at += size;
        }
        if (!parts || (attributes == 0 && !first)) return;
    }
}

}  // namespace searchlight
