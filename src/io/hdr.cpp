// Radiance's RGBE pictures [Ward1991]: three 8-bit mantissas that share an exponent. Read by our own code, since
// stb_image takes a file that is cut off for one that ends in black.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "base/error.h"
#include "base/text.h"
#include "io/image_formats.h"

namespace searchlight {

namespace {

using Rgbe = std::array<std::uint8_t, 4>;

class HdrReader {
public:
    explicit HdrReader(std::string_view bytes) : bytes_(bytes) {}

    Image run() {
        if (!bytes_.starts_with("#?")) throw inputError("is no Radiance picture", "expected '#?RADIANCE' at its start");
        readHeader();
        readSize();
        std::vector<Rgbe> row(static_cast<std::size_t>(image_.width));
        for (int y = 0; y < image_.height; ++y) {
            readRow(row, y);
            for (int x = 0; x < image_.width; ++x) image_.at(x, y) = decoded(row[static_cast<std::size_t>(x)]);
        }
        return std::move(image_);
    }

private:
    std::string_view line() {
        const std::size_t end = bytes_.find('\n', at_);
        if (end == std::string_view::npos) throw cutOff();
        std::string_view text = bytes_.substr(at_, end - at_);
        at_ = end + 1;
        if (text.ends_with('\r')) text.remove_suffix(1);
        return text;
    }

    void readHeader() {
        for (std::string_view text = line(); !text.empty(); text = line()) {
            if (text.starts_with("FORMAT=") && trim(text.substr(7)) != "32-bit_rle_rgbe")
                throw inputError(fmt::format("the pixels are '{}'", text.substr(7, 40)), "expected 32-bit_rle_rgbe");
            if (!text.starts_with("EXPOSURE=")) continue;
            const std::optional<double> exposure = parseNumber(trim(text.substr(9)));
            if (!exposure || *exposure <= 0)
                throw inputError(fmt::format("'{}' is no exposure", text.substr(9, 40)), "expected a positive number");
            exposure_ *= *exposure;
        }
    }

    void readSize() {
        const std::string_view text = line();
        std::vector<std::string_view> parts;
        for (const std::string_view part : split(text, ' '))
            if (!part.empty()) parts.push_back(part);
        const std::optional<double> height = parts.size() == 4 ? parseNumber(parts[1]) : std::nullopt;
        const std::optional<double> width = parts.size() == 4 ? parseNumber(parts[3]) : std::nullopt;
        if (!width || !height || parts[0] != "-Y" || parts[2] != "+X" || *width != std::floor(*width) ||
            *height != std::floor(*height))
            throw inputError(fmt::format("the size is '{}'", text.substr(0, 40)), "expected '-Y HEIGHT +X WIDTH'");
        // A run of 127 pixels takes two bytes for each of four components.
        checkSize(*width, *height, static_cast<double>(bytes_.size()), 127. / 8);
        image_ = Image(static_cast<int>(*width), static_cast<int>(*height));
    }

    std::uint8_t byte() {
        if (at_ >= bytes_.size()) throw cutOff();
        return static_cast<std::uint8_t>(bytes_[at_++]);
    }

    Error cutOff() const {
        return inputError(fmt::format("the file ends at byte {}, before its pixels do", bytes_.size()));
    }

    void readRow(std::vector<Rgbe>& row, int y) {
        Rgbe first{};
        for (std::uint8_t& component : first) component = byte();
        const bool runs = row.size() >= 8 && row.size() < 32768 && first[0] == 2 && first[1] == 2 && first[2] < 128;
        if (!runs) {
            readFlat(row, first);
            return;
        }
        if (static_cast<std::size_t>(first[2]) * 256 + first[3] != row.size())
            throw inputError(fmt::format("row {} is {} pixels wide", y, first[2] * 256 + first[3]),
                             fmt::format("expected {}", row.size()));
        for (std::size_t component = 0; component < 4; ++component) {
            for (std::size_t x = 0; x < row.size();) {
                const std::uint8_t count = byte();
                const bool run = count > 128;
                const std::size_t length = run ? count - 128u : count;
                if (length == 0 || length > row.size() - x)
                    throw inputError(fmt::format("byte {}: a run of {} pixels in row {}", at_ - 1, length, y),
                                     fmt::format("expected 1 to {}", row.size() - x));
                if (run) {
                    const std::uint8_t value = byte();
                    for (std::size_t i = 0; i < length; ++i) row[x++][component] = value;
                } else {
                    for (std::size_t i = 0; i < length; ++i) row[x++][component] = byte();
                }
            }
        }
    }

    // Pixel by pixel; (1, 1, 1, n) repeats the one before, n times, and a second such pixel n * 256 times.
    void readFlat(std::vector<Rgbe>& row, Rgbe pixel) {
        int shift = 0;
        for (std::size_t x = 0; x < row.size();) {
            if (x > 0 && pixel[0] == 1 && pixel[1] == 1 && pixel[2] == 1 && shift < 24) {
                const std::size_t count = static_cast<std::size_t>(pixel[3]) << shift;
                for (std::size_t i = 0; i < count && x < row.size(); ++i, ++x) row[x] = row[x - 1];
                shift += 8;
            } else {
                row[x++] = pixel;
                shift = 0;
            }
            if (x < row.size())
                for (std::uint8_t& component : pixel) component = byte();
        }
    }

    Rgba decoded(const Rgbe& pixel) const {
        if (pixel[3] == 0) return {0, 0, 0, 1};
        const double factor = std::ldexp(1.0, pixel[3] - 136) / exposure_;
        return {static_cast<float>(pixel[0] * factor), static_cast<float>(pixel[1] * factor),
                static_cast<float>(pixel[2] * factor), 1};
    }

    std::string_view bytes_;
    std::size_t at_ = 0;
    double exposure_ = 1;
    Image image_;
};

// What the exponent's 8 bits can hold; NaN and what is negative become 0.
double representable(float value) {
    return value > 0 ? std::min(static_cast<double>(value), std::ldexp(255., 119)) : 0;
}

Rgbe encoded(const Rgba& pixel) {
    const double r = representable(pixel.r), g = representable(pixel.g), b = representable(pixel.b);
    const double largest = std::max({r, g, b});
    int exponent = 0;
    std::frexp(largest, &exponent);
    if (std::round(std::ldexp(largest, 8 - exponent)) > 255) ++exponent;
    if (largest == 0 || exponent < -127) return {};
    const auto mantissa = [&](double value) {
        return static_cast<std::uint8_t>(std::round(std::ldexp(value, 8 - exponent)));
    };
    return {mantissa(r), mantissa(g), mantissa(b), static_cast<std::uint8_t>(exponent + 128)};
}

// One component of a row: runs of 4 equal bytes or more, and what lies between them.
void appendRuns(std::string& bytes, const std::vector<Rgbe>& row, std::size_t component) {
    const auto run_at = [&](std::size_t begin) {
        std::size_t end = begin + 1;
        while (end < row.size() && end - begin < 127 && row[end][component] == row[begin][component]) ++end;
        return end - begin;
    };
    for (std::size_t x = 0; x < row.size();) {
        if (const std::size_t length = run_at(x); length >= 4) {
            bytes += static_cast<char>(128 + length);
            bytes += static_cast<char>(row[x][component]);
            x += length;
            continue;
        }
        const std::size_t begin = x;
        do ++x;
        while (x < row.size() && x - begin < 128 && run_at(x) < 4);
        bytes += static_cast<char>(x - begin);
        for (std::size_t i = begin; i < x; ++i) bytes += static_cast<char>(row[i][component]);
    }
}

}  // namespace

ImageFile parseHdr(std::string_view bytes) { return {HdrReader(bytes).run(), {}, {}}; }

std::string hdrBytes(const Image& image) {
    std::string bytes = fmt::format("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {} +X {}\n", image.height, image.width);
    const bool runs = image.width >= 8 && image.width < 32768;
    std::vector<Rgbe> row(static_cast<std::size_t>(image.width));
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) row[static_cast<std::size_t>(x)] = encoded(image.at(x, y));
        if (!runs) {
            for (const Rgbe& pixel : row)
                for (const std::uint8_t component : pixel) bytes += static_cast<char>(component);
            continue;
        }
        for (const int lead : {2, 2, image.width / 256, image.width % 256}) bytes += static_cast<char>(lead);
        for (std::size_t component = 0; component < 4; ++component) appendRuns(bytes, row, component);
    }
    return bytes;
}

}  // namespace searchlight
