// Pictures that are damaged or that lie about their size: refused with a reason, before memory is taken.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "base/error.h"
#include "base/files.h"
#include "io/image_file.h"

namespace searchlight {
namespace {

std::string message(const std::string& bytes, const std::string& path) {
    try {
        parseImage(bytes, path);
    } catch (const Error& error) {
        EXPECT_EQ(error.kind, ErrorKind::input);
        return error.what();
    }
    return "no error";
}

std::string written(const std::string& ending) {
    Image image(19, 11);
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        const float value = static_cast<float>((i * 7919) % 256) / 256;
        image.pixels[i] = {value, 1 - value, value * value, value};
    }
    const std::filesystem::path folder = std::filesystem::path(SEARCHLIGHT_BINARY_DIR) / "tests/io_illegal";
    std::filesystem::create_directories(folder);
    const std::string path = (folder / ("picture" + ending)).string();
    writeImage(path, {image, {}, {{"job", "{}"}}});
    return readFile(path);
}

std::string replaced(std::string bytes, std::size_t at, std::string_view by) {
    return bytes.replace(at, by.size(), by);
}

// The four bytes of a number, the lowest first.
std::string littleEndian(std::uint32_t value) {
    std::string bytes;
    for (int shift = 0; shift < 32; shift += 8) bytes += static_cast<char>(value >> shift & 0xff);
    return bytes;
}

TEST(IllegalImages, AnyEndingIsRefused) {
    EXPECT_EQ(message("", "a.exr"), "a.exr: is no OpenEXR file (expected the bytes 76 2f 31 01 at its start)");
    EXPECT_EQ(message("", "a.hdr"), "a.hdr: is no Radiance picture (expected '#?RADIANCE' at its start)");
    EXPECT_EQ(message("", "a.pfm"), "a.pfm: is no portable float map (expected 'PF' or 'Pf' at its start)");
    EXPECT_EQ(message("GIF89a", "a.png"),
              "a.png: is no PNG file (expected the bytes 89 50 4e 47 0d 0a 1a 0a at its start)");
}

// Wherever a file is cut, nobody takes the rest for a picture.
TEST(IllegalImages, EveryPartOfAFileIsRefused) {
    for (const std::string ending : {".exr", ".hdr", ".pfm", ".png"}) {
        const std::string bytes = written(ending);
        ASSERT_EQ(message(bytes, "a" + ending), "no error");
        for (std::size_t size = 0; size < bytes.size(); ++size) {
            const std::string text = message(bytes.substr(0, size), "a" + ending);
            ASSERT_TRUE(text.starts_with("a" + ending + ": ")) << ending << " cut at " << size << ": " << text;
        }
    }
}

TEST(IllegalImages, ExrOfHostileSize) {
    const std::string bytes = written(".exr");
    // xMin, yMin, xMax, yMax behind the name, the type and the size.
    const std::size_t data = bytes.find("dataWindow") + 11 + 6 + 4, display = bytes.find("displayWindow") + 14 + 6 + 4;
    const auto sized = [&](std::uint32_t width, std::uint32_t height) {
        const std::string corner = littleEndian(width - 1) + littleEndian(height - 1);
        return message(replaced(replaced(bytes, data + 8, corner), display + 8, corner), "a.exr");
    };
    EXPECT_EQ(sized(100000, 11), fmt::format("a.exr: {} bytes are too few for 100000 x 11 pixels (the file is cut off, "
                                             "or its size is not what it says)",
                                             bytes.size()));
    EXPECT_EQ(sized(1 << 29, 11), "a.exr: the picture is 536870912 x 11 pixels (at most 536870912 pixels are read)");
    EXPECT_EQ(message(replaced(bytes, display + 8, littleEndian(20000)), "a.exr"),
              "a.exr: the display window, 20001 x 11, is more than 64 times the data window, 19 x 11");
    // Too high for its table of rows, which is looked for before memory for it is taken.
    EXPECT_TRUE(sized(19, 1u << 30).starts_with("a.exr: "));
}

TEST(IllegalImages, ExrAttributeOfHostileSize) {
    const std::string bytes = written(".exr");
    const std::size_t at = bytes.find("string") + 7;
    EXPECT_EQ(message(replaced(bytes, at, littleEndian(1900000000)), "a.exr"),
              fmt::format("a.exr: byte {}: an attribute of 1900000000 bytes (the file has {} more)", at,
                          bytes.size() - at - 4));
}

TEST(IllegalImages, ExrWithoutColours) {
    std::string bytes = written(".exr");
    const std::size_t channels = bytes.find("chlist") + 7 + 4;
    ASSERT_EQ(bytes.substr(channels, 2), std::string("A\0", 2));
    std::string other = bytes;
    for (std::size_t i = 0; i < 4; ++i) other[channels + 18 * i] = "UVWX"[i];
    EXPECT_EQ(message(other, "a.exr"), "a.exr: no channels R, G, B or Y (the file has U, V, W, X)");
    other = bytes;
    other[channels + 2 + 8] = 2;  // xSampling of A
    EXPECT_TRUE(message(other, "a.exr").starts_with("a.exr: ")) << message(other, "a.exr");
}

TEST(IllegalImages, HdrHeaders) {
    const auto with = [](const std::string& rest) { return message("#?RADIANCE\n" + rest, "a.hdr"); };
    EXPECT_EQ(with("FORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\n1234"),
              "a.hdr: the pixels are '32-bit_rle_xyze' (expected 32-bit_rle_rgbe)");
    EXPECT_EQ(with("EXPOSURE=0\n\n"), "a.hdr: '0' is no exposure (expected a positive number)");
    EXPECT_EQ(with("\n+Y 1 +X 1\n1234"), "a.hdr: the size is '+Y 1 +X 1' (expected '-Y HEIGHT +X WIDTH')");
    EXPECT_EQ(with("\n-Y 1.5 +X 1\n1234"), "a.hdr: the size is '-Y 1.5 +X 1' (expected '-Y HEIGHT +X WIDTH')");
    EXPECT_EQ(with("\n-Y 0 +X 1\n1234"), "a.hdr: the picture is 1 x 0 pixels (expected at least 1 x 1)");
    EXPECT_EQ(with("\n-Y 1e9 +X 1e9\n1234"),
              "a.hdr: the picture is 1000000000 x 1000000000 pixels (at most 536870912 pixels are read)");
    EXPECT_EQ(
        with("\n-Y 5000 +X 5000\n1234"),
        "a.hdr: 32 bytes are too few for 5000 x 5000 pixels (the file is cut off, or its size is not what it says)");
    EXPECT_EQ(with("\n-Y 1 +X 1\n123"), "a.hdr: the file ends at byte 25, before its pixels do");
    EXPECT_EQ(with(std::string("\n-Y 1 +X 8\n\x02\x02\x00\x09", 15)), "a.hdr: row 0 is 9 pixels wide (expected 8)");
    EXPECT_EQ(with(std::string("\n-Y 1 +X 8\n\x02\x02\x00\x08\x89\x01", 17)),
              "a.hdr: byte 26: a run of 9 pixels in row 0 (expected 1 to 8)");
    EXPECT_EQ(with(std::string("\n-Y 1 +X 8\n\x02\x02\x00\x08\x00\x01", 17)),
              "a.hdr: byte 26: a run of 0 pixels in row 0 (expected 1 to 8)");
}

TEST(IllegalImages, PfmHeaders) {
    const std::string hint = " (expected 'PF', width, height, scale, and the floats)";
    EXPECT_EQ(message("PF\nwide 1 -1\n", "a.pfm"), "a.pfm: 'wide' is no width" + hint);
    EXPECT_EQ(message("PF\n1 1.5 -1\n", "a.pfm"), "a.pfm: '1.5' is no height" + hint);
    EXPECT_EQ(message("PF\n1 1 nan\n", "a.pfm"), "a.pfm: 'nan' is no scale" + hint);
    EXPECT_EQ(message("PF\n1 1 0\n", "a.pfm"),
              "a.pfm: the scale is 0 (expected -1 for little-endian floats, 1 for big-endian ones)");
    EXPECT_EQ(message("PF\n-1 1 -1\n", "a.pfm"), "a.pfm: the picture is -1 x 1 pixels (expected at least 1 x 1)");
    EXPECT_EQ(message("PF\n100 100 -1\n123", "a.pfm"),
              "a.pfm: 3 bytes are too few for 100 x 100 pixels (the file is cut off, or its size is not what it says)");
}

TEST(IllegalImages, PngChunks) {
    const std::string bytes = written(".png");
    EXPECT_EQ(message(replaced(bytes, 40, "X"), "a.png"),
              "a.png: byte 33: the checksum of chunk sRGX is wrong (the file is damaged)");
    EXPECT_EQ(message(bytes.substr(0, 8) + bytes.substr(33), "a.png"),
              "a.png: byte 8: chunk sRGB (IHDR comes first, and once)");
    EXPECT_EQ(message(bytes.substr(0, bytes.size() - 1), "a.png"),
              fmt::format("a.png: the file ends at byte {}, before its last chunk", bytes.size() - 1));
    // A size of 2^28 x 2^28 with the checksum that belongs to it.
    const std::string huge("\x10\0\0\0\x10\0\0\0", 8);
    EXPECT_EQ(message(replaced(replaced(bytes, 16, huge), 29, "\x23\x4c\x98\xb9"), "a.png"),
              "a.png: the picture is 268435456 x 268435456 pixels (at most 536870912 pixels are read)");
}

}  // namespace
}  // namespace searchlight
