// PNG files: stb_image inflates the pixels; size, checksums and texts are looked at here first.
#include <fmt/format.h>
#include <zlib.h>

#include <array>
#include <cstdint>
#include <memory>

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#define STBI_NO_STDIO
#include <stb/stb_image.h>

#include "base/error.h"
#include "base/png_chunks.h"
#include "base/srgb.h"
#include "io/image_formats.h"

namespace searchlight {

namespace {

std::uint32_t bigEndian(std::string_view bytes, std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<std::uint8_t>(bytes[at + i]);
    return value;
}

std::string utf8FromLatin1(std::string_view text) {
    std::string utf8;
    for (const char letter : text) {
        const auto code = static_cast<std::uint8_t>(letter);
        if (code < 0x80) {
            utf8 += letter;
        } else {
            utf8 += static_cast<char>(0xc0 | code >> 6);
            utf8 += static_cast<char>(0x80 | (code & 0x3f));
        }
    }
    return utf8;
}

struct Header {
    std::uint32_t width = 0, height = 0;
    int depth = 0;  // bits per sample
};

class PngChunks {
public:
    explicit PngChunks(std::string_view bytes) : bytes_(bytes) {}

    Header header;
    std::vector<std::pair<std::string, std::string>> texts;

    void read() {
        std::size_t at = 8;
        for (bool end = false; !end;) {
            if (at + 12 > bytes_.size()) throw cutOff();
            const std::uint32_t length = bigEndian(bytes_, at);
            if (length > bytes_.size() - at - 12) throw cutOff();
            const std::string_view type = bytes_.substr(at + 4, 4), data = bytes_.substr(at + 8, length);
            const auto* checked = reinterpret_cast<const Bytef*>(bytes_.data() + at + 4);
            if (crc32(0, checked, length + 4) != bigEndian(bytes_, at + 8 + length))
                throw inputError(fmt::format("byte {}: the checksum of chunk {} is wrong", at, printable(type)),
                                 "the file is damaged");
            if ((at == 8) != (type == "IHDR"))
                throw inputError(fmt::format("byte {}: chunk {}", at, printable(type)), "IHDR comes first, and once");
            if (type == "IHDR") readHeader(data);
            if (type == "tEXt") readText(data);
            if (type == "iTXt") readUnicode(data);
            end = type == "IEND";
            at += 12 + length;
        }
    }

private:
    Error cutOff() const {
        return inputError(fmt::format("the file ends at byte {}, before its last chunk", bytes_.size()));
    }

    void readHeader(std::string_view data) {
        if (data.size() != 13) throw inputError("chunk IHDR has another size", "expected 13 bytes");
        header = {bigEndian(data, 0), bigEndian(data, 4), data[8]};
        const int type = data[9];
        const int samples = type == 2 ? 3 : type == 4 ? 2 : type == 6 ? 4 : 1;
        // zlib makes at most 1032 bytes of one.
        checkSize(header.width, header.height, static_cast<double>(bytes_.size()),
                  1040. * 8 / (samples * std::max(header.depth, 1)));
    }

    void readText(std::string_view data) {
        const std::size_t end = data.find('\0');
        if (end != std::string_view::npos)
            texts.emplace_back(utf8FromLatin1(data.substr(0, end)), utf8FromLatin1(data.substr(end + 1)));
    }

    // Keyword, 0, compressed or not, method, language, 0, translated keyword, 0, text.
    void readUnicode(std::string_view data) {
        const std::size_t end = data.find('\0');
        if (end == std::string_view::npos || data.size() < end + 3 || data[end + 1] != 0) return;
        const std::size_t language = data.find('\0', end + 3);
        if (language == std::string_view::npos) return;
        const std::size_t translated = data.find('\0', language + 1);
        if (translated == std::string_view::npos) return;
        texts.emplace_back(utf8FromLatin1(data.substr(0, end)), data.substr(translated + 1));
    }

    std::string_view bytes_;
};

// Straight code values to linear, premultiplied.
template <class Sample>
Image linearImage(const Sample* samples, int width, int height) {
    constexpr int largest = std::numeric_limits<Sample>::max();
    std::vector<float> linear(largest + 1);
    for (int i = 0; i <= largest; ++i)
        linear[static_cast<std::size_t>(i)] = static_cast<float>(linearFromSrgb(i / static_cast<double>(largest)));
    Image image(width, height);
    for (Rgba& pixel : image.pixels) {
        pixel.a = static_cast<float>(samples[3]) / static_cast<float>(largest);
        pixel.r = pixel.a * linear[samples[0]];
        pixel.g = pixel.a * linear[samples[1]];
        pixel.b = pixel.a * linear[samples[2]];
        samples += 4;
    }
    return image;
}

template <class Sample>
Image decode(std::string_view bytes, Sample* (*load)(stbi_uc const*, int, int*, int*, int*, int)) {
    int width = 0, height = 0, channels = 0;
    const std::unique_ptr<Sample, void (*)(void*)> samples(
        load(reinterpret_cast<const stbi_uc*>(bytes.data()), static_cast<int>(bytes.size()), &width, &height, &channels,
             4),
        stbi_image_free);
    if (!samples) throw inputError(fmt::format("the pixels cannot be read: {}", stbi_failure_reason()));
    return linearImage(samples.get(), width, height);
}

}  // namespace

ImageFile parsePng(std::string_view bytes) {
    if (!bytes.starts_with(png_signature))
        throw inputError("is no PNG file", "expected the bytes 89 50 4e 47 0d 0a 1a 0a at its start");
    if (bytes.size() > static_cast<std::size_t>(std::numeric_limits<int>::max()))
        throw inputError("the file is larger than 2 GiB");
    PngChunks chunks(bytes);
    chunks.read();
    ImageFile file;
    file.image = chunks.header.depth == 16 ? decode<stbi_us>(bytes, stbi_load_16_from_memory)
                                           : decode<stbi_uc>(bytes, stbi_load_from_memory);
    file.metadata = std::move(chunks.texts);
    return file;
}

}  // namespace searchlight
