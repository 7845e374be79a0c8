#include "io/image_file.h"

#include <fmt/format.h>

#include <array>
#include <filesystem>

#include "base/error.h"
#include "base/files.h"
#include "base/text.h"
#include "io/image_formats.h"

namespace searchlight {

namespace {

// 16384 x 8192 RGBA in float and some layers.
constexpr std::size_t max_bytes = std::size_t{1} << 33;

struct Format {
    std::string_view ending;
    ImageFile (*parse)(std::string_view bytes);
    std::string (*write)(const ImageFile& file, const ToneMap& tone_map);
};

constexpr std::array<Format, 4> formats{{
    {".exr", parseExr, [](const ImageFile& file, const ToneMap&) { return exrBytes(file); }},
    {".hdr", parseHdr, [](const ImageFile& file, const ToneMap&) { return hdrBytes(file.image); }},
    {".pfm", parsePfm, [](const ImageFile& file, const ToneMap&) { return pfmBytes(file.image); }},
    {".png", parsePng, pngBytes},
}};

const Format& formatOf(const std::string& path, ErrorKind kind) {
    std::string ending = std::filesystem::path(path).extension().string();
    for (char& letter : ending)
        if (letter >= 'A' && letter <= 'Z') letter = static_cast<char>(letter - 'A' + 'a');
    for (const Format& format : formats)
        if (format.ending == ending) return format;
    const std::string valid = join(imageEndings(), ", ");
    throw Error(kind,
                ending.empty() ? "a picture's format is told by its ending, and there is none"
                               : fmt::format("'{}' is no picture format that is known here", ending),
                "valid: " + valid)
        .at(path);
}

}  // namespace

void checkSize(double width, double height, double bytes, double pixels_per_byte) {
    const double pixels = width * height;
    if (!(width >= 1 && height >= 1))
        throw inputError(fmt::format("the picture is {:.0f} x {:.0f} pixels", width, height),
                         "expected at least 1 x 1");
    if (pixels > max_pixels)
        throw inputError(fmt::format("the picture is {:.0f} x {:.0f} pixels", width, height),
                         fmt::format("at most {:.0f} pixels are read", max_pixels));
    if (pixels > pixels_per_byte * bytes)
        throw inputError(fmt::format("{:.0f} bytes are too few for {:.0f} x {:.0f} pixels", bytes, width, height),
                         "the file is cut off, or its size is not what it says");
}

std::string printable(std::string_view text) {
    std::string clean(text.substr(0, 40));
    for (char& letter : clean)
        if (letter < ' ' || letter > '~') letter = '?';
    return clean;
}

ImageFile readImage(const std::string& path) {
    formatOf(path, ErrorKind::input);  // before the file is read
    return parseImage(readFile(path, max_bytes), path);
}

ImageFile parseImage(std::string_view bytes, const std::string& path) {
    try {
        return formatOf(path, ErrorKind::input).parse(bytes);
    } catch (const Error& error) {
        throw error.at(path);
    }
}

std::string imageBytes(const std::string& path, const ImageFile& file, const ToneMap& tone_map) {
    const Format& format = formatOf(path, ErrorKind::usage);
    if (file.image.empty()) throw usageError("the picture is empty").at(path);
    return format.write(file, tone_map);
}

void writeImage(const std::string& path, const ImageFile& file, const ToneMap& tone_map) {
    writeFile(path, imageBytes(path, file, tone_map));
}

std::vector<std::string> imageEndings() {
    std::vector<std::string> endings;
    for (const Format& format : formats) endings.emplace_back(format.ending);
    return endings;
}

}  // namespace searchlight
