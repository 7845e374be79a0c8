#include "io/image_file.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>

#include "base/error.h"
#include "base/files.h"
#include "base/srgb.h"

namespace searchlight {
namespace {

namespace fs = std::filesystem;

std::string temporary(const std::string& name) {
    const fs::path folder = fs::path(SEARCHLIGHT_BINARY_DIR) / "tests/io_images";
    fs::create_directories(folder);
    return (folder / name).string();
}

// No two pixels alike, over eight decades, partly covered.
Image gradient(int width, int height) {
    Image image(width, height);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const float u = static_cast<float>(x) / static_cast<float>(width);
            const float v = static_cast<float>(y) / static_cast<float>(height);
            image.at(x, y) = {std::pow(10.f, 8 * u - 4), v * u, -v, (u + v) / 2};
        }
    }
    return image;
}

ImageFile readBack(const std::string& name, const ImageFile& file, const ToneMap& tone_map = {}) {
    writeImage(temporary(name), file, tone_map);
    return readImage(temporary(name));
}

TEST(Exr, KeepsEveryBitLayersAndMetadata) {
    ImageFile file{gradient(37, 21), {{"stderr", gradient(37, 21)}}, {{"seed", "7"}, {"version", "0.1 µ"}}};
    file.image.at(3, 4) = {std::numeric_limits<float>::infinity(), std::numeric_limits<float>::denorm_min(), -0.f, 1};
    const ImageFile back = readBack("all.exr", file);
    EXPECT_EQ(back.image.width, 37);
    EXPECT_EQ(back.image.pixels, file.image.pixels);
    ASSERT_EQ(back.layers.size(), 1u);
    EXPECT_EQ(back.layers[0].name, "stderr");
    EXPECT_EQ(back.layers[0].image.pixels, file.layers[0].image.pixels);
    EXPECT_EQ(back.metadata, file.metadata);
}

TEST(Pfm, KeepsColoursExactly) {
    const Image image = gradient(13, 7);
    const Image back = readBack("colours.pfm", {image, {}, {}}).image;
    ASSERT_EQ(back.pixels.size(), image.pixels.size());
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        const Rgba expected{image.pixels[i].r, image.pixels[i].g, image.pixels[i].b, 1};
        EXPECT_EQ(back.pixels[i], expected) << i;
    }
}

TEST(Pfm, BigEndianAndGreyAreRead) {
    const Image image = parseImage(std::string("Pf\n2 1\n1.0\n\x3f\x80\0\0\xc0\0\0\0", 20), "a.pfm").image;
    EXPECT_EQ(image.at(0, 0), (Rgba{1, 1, 1, 1}));
    EXPECT_EQ(image.at(1, 0), (Rgba{-2, -2, -2, 1}));
}

// Both a width that is run-length coded and one that is not. The shared exponent leaves the largest component 8 bits:
// half a unit of the last place is 1/256 of it at most, and the same amount of the others.
TEST(Hdr, KeepsEightBitsOfTheLargestComponent) {
    for (const int width : {5, 200}) {
        const Image image = gradient(width, 9);
        const Image back = readBack("rgbe.hdr", {image, {}, {}}).image;
        for (std::size_t i = 0; i < image.pixels.size(); ++i) {
            const Rgba a = image.pixels[i], b = back.pixels[i];
            const float bound = std::max({a.r, a.g, a.b}) / 256;
            EXPECT_NEAR(a.r, b.r, bound);
            EXPECT_NEAR(a.g, b.g, bound);
            EXPECT_EQ(b.b, 0);  // it was negative
        }
    }
}

TEST(Hdr, RunsOfTheFormatAndItsExposureAreRead) {
    // 8 pixels: components as a run, as literals, and both; the exposure is divided out.
    const std::string head = "#?RGBE\n# made by hand\nEXPOSURE=2\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 8\n";
    const std::string row("\x02\x02\x00\x08\x88\x80\x08\x01\x02\x03\x04\x05\x06\x07\x08\x84\x40\x84\x20\x88\x81", 21);
    const Image image = parseImage(head + row, "a.hdr").image;
    EXPECT_EQ(image.at(0, 0), (Rgba{0.5f, 1 / 256.f, 0.25f, 1}));
    EXPECT_EQ(image.at(7, 0), (Rgba{0.5f, 8 / 256.f, 0.125f, 1}));
    // The older runs: a pixel of 1, 1, 1 and n repeats the last one n times.
    const Image old = parseImage("#?RGBE\n\n-Y 1 +X 9\n\x80\x40\x20\x80\x01\x01\x01\x08", "a.hdr").image;
    EXPECT_EQ(old.at(8, 0), (Rgba{0.5f, 0.25f, 0.125f, 1}));
}

TEST(Png, KeepsCodeValuesAndTexts) {
    ImageFile file{Image(256, 3), {}, {{"job", "{\"a\": 1}"}, {"note", "Größe µ"}}};
    for (int x = 0; x < 256; ++x) {
        const auto linear = static_cast<float>(linearFromSrgb(x / 255.));
        file.image.at(x, 0) = {linear, linear, linear, 1};
        const float alpha = static_cast<float>(x) / 255;
        file.image.at(x, 1) = {alpha * linear, 0, alpha, alpha};  // premultiplied
        file.image.at(x, 2) = {2 * linear, -linear, 0, 1};
    }
    const ImageFile back = readBack("codes.png", file);
    EXPECT_EQ(back.metadata, file.metadata);
    for (int x = 0; x < 256; ++x) {
        // Float rounding of a premultiplied value and back.
        for (const int y : {0, 1}) {
            EXPECT_NEAR(back.image.at(x, y).r, file.image.at(x, y).r, 2e-7) << x;
            EXPECT_NEAR(back.image.at(x, y).b, file.image.at(x, y).b, 2e-7) << x;
            EXPECT_EQ(back.image.at(x, y).a, file.image.at(x, y).a) << x;
        }
        EXPECT_LE(back.image.at(x, 2).r, 1) << "clamped";
        EXPECT_EQ(back.image.at(x, 2).g, 0);
    }
}

TEST(Png, OpaquePicturesHaveNoAlpha) {
    writeImage(temporary("opaque.png"), {Image(4, 4, {1, 1, 1, 1}), {}, {}});
    EXPECT_EQ(readFile(temporary("opaque.png"))[25], 2);  // colour type RGB
}

// Two files by another writer: 16-bit grey, and a palette of 1 bit with a transparent colour.
TEST(Png, SixteenBitsAndPalettesAreRead) {
    const std::string grey(
        "\x89\x50\x4e\x47\x0d\x0a\x1a\x0a\x00\x00\x00\x0d\x49\x48\x44\x52\x00\x00\x00\x02\x00\x00\x00\x01"
        "\x10\x00\x00\x00\x00\x81\xd9\xfc\x15\x00\x00\x00\x0d\x49\x44\x41\x54\x78\xda\x63\x10\x32\xf9\xff"
        "\x1f\x00\x03\xe6\x02\x45\xf1\x1c\x84\x65\x00\x00\x00\x00\x49\x45\x4e\x44\xae\x42\x60\x82",
        70);
    const Image deep = parseImage(grey, "a.png").image;
    EXPECT_EQ(deep.at(0, 0).g, static_cast<float>(linearFromSrgb(0x1234 / 65535.)));
    EXPECT_EQ(deep.at(1, 0), (Rgba{1, 1, 1, 1}));
    const std::string palette(
        "\x89\x50\x4e\x47\x0d\x0a\x1a\x0a\x00\x00\x00\x0d\x49\x48\x44\x52\x00\x00\x00\x02\x00\x00\x00\x01"
        "\x01\x03\x00\x00\x00\xce\xec\xed\xc9\x00\x00\x00\x06\x50\x4c\x54\x45\xff\x00\x00\x00\xff\x00\xd2"
        "\x87\xef\x71\x00\x00\x00\x02\x74\x52\x4e\x53\xff\x00\xe5\xb7\x30\x4a\x00\x00\x00\x0a\x49\x44\x41"
        "\x54\x78\xda\x63\x70\x00\x00\x00\x42\x00\x41\x84\xbf\x8e\x62\x00\x00\x00\x00\x49\x45\x4e\x44\xae"
        "\x42\x60\x82",
        99);
    const Image coloured = parseImage(palette, "a.png").image;
    EXPECT_EQ(coloured.at(0, 0), (Rgba{1, 0, 0, 1}));
    EXPECT_EQ(coloured.at(1, 0), (Rgba{0, 0, 0, 0}));
}

TEST(ToneMap, SrgbIsTheStandardsCurve) {
    // IEC 61966-2-1: 18 % grey has the code value 117.6 of 255, and the two pieces meet.
    EXPECT_NEAR(srgbFromLinear(0.18) * 255, 117.6, 0.1);
    EXPECT_NEAR(srgbFromLinear(0.0031308), 12.92 * 0.0031308, 1e-12);
    EXPECT_NEAR(1.055 * std::pow(0.0031308, 1 / 2.4) - 0.055, 12.92 * 0.0031308, 1e-7);
    for (double code = 0; code <= 1; code += 1. / 64) EXPECT_NEAR(srgbFromLinear(linearFromSrgb(code)), code, 1e-7);
    EXPECT_EQ(displayed({0.5f, 1, 4, 1}, {}).g, 1);
    EXPECT_EQ(displayed({0.5f, 1, 4, 1}, {}).b, 1);
}

TEST(ToneMap, ExposureIsInStopsAndGammaOnTop) {
    const Rgba one = displayed({0.1f, 0.2f, 0.3f, 1}, {.exposure = 1});
    const Rgba doubled = displayed({0.2f, 0.4f, 0.6f, 1}, {});
    EXPECT_EQ(one, doubled);
    EXPECT_NEAR(displayed({0.2f, 0, 0, 1}, {.gamma = 2}).r, std::sqrt(srgbFromLinear(0.2f)), 1e-6);
}

TEST(ToneMap, CoverageIsDividedOut) {
    EXPECT_EQ(displayed({0.25f, 0.125f, 0, 0.5f}, {}).r, displayed({0.5f, 0.25f, 0, 1}, {}).r);
    EXPECT_EQ(displayed({1, 1, 1, 0}, {}), (Rgba{0, 0, 0, 0}));
    const float nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(displayed({nan, nan, nan, 1}, {}), (Rgba{0, 0, 0, 1}));
}

TEST(ToneMap, FilmicRisesToWhite) {
    const ToneMap filmic{.curve = ToneMap::Curve::filmic};
    float last = -1;
    for (float radiance = 0; radiance < 8; radiance += 0.125f) {
        const float code = displayed({radiance, 0, 0, 1}, filmic).r;
        EXPECT_GE(code, last);
        last = code;
    }
    EXPECT_EQ(last, 1);
    EXPECT_EQ(displayed({std::numeric_limits<float>::infinity(), 0, 0, 1}, filmic).r, 1);
    // [Narkowicz2015] at 18 % grey: 0.18 (2.51 0.18 + 0.03) / (0.18 (2.43 0.18 + 0.59) + 0.14) = 0.26689.
    EXPECT_NEAR(linearFromSrgb(displayed({0.18f, 0, 0, 1}, filmic).r), 0.26689, 1e-5);
}

TEST(ImageFile, EndingsDecideAndAreNamed) {
    const auto message = [](auto act) {
        try {
            act();
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string("no error");
    };
    EXPECT_EQ(message([] { parseImage("", "a.tif"); }),
              "a.tif: '.tif' is no picture format that is known here (valid: .exr, .hdr, .pfm, .png)");
    EXPECT_EQ(message([] {
                  writeImage("a", {Image(1, 1), {}, {}});
              }),
              "a: a picture's format is told by its ending, and there is none (valid: .exr, .hdr, .pfm, .png)");
    EXPECT_EQ(message([] { writeImage("a.exr", {}); }), "a.exr: the picture is empty");
    EXPECT_EQ(readBack("LOUD.PNG", {Image(2, 2, {1, 1, 1, 1}), {}, {}}).image.width, 2);
}

// What others wrote: half floats and floats, compressed by ZIP, PIZ and DWAB. The pictures are large and not part of
// the repository; the integrals over the sphere are those that other decoders gave.
TEST(ImageFile, ReadsEnvironmentMapsOfOthers) {
    const std::string folder = SEARCHLIGHT_SOURCE_DIR "/../shared/data/envmaps/";
    if (!fs::exists(folder)) GTEST_SKIP() << folder << " is absent";
    const std::vector<std::pair<std::string, Rgb>> maps{{"venice_sunset_1k.hdr", {6.421, 6.061, 7.704}},
                                                        {"grace_latlong.exr", {0.281, 0.156, 0.193}},
                                                        {"museum.exr", {6.427, 5.233, 4.634}},
                                                        {"blender_courtyard.exr", {11.57, 9.11, 9.04}}};
    for (const auto& [name, expected] : maps) {
        const Image image = readImage(folder + name).image;
        Rgb integral;
        for (int y = 0; y < image.height; ++y) {
            const double pi = std::numbers::pi, row = pi / image.height;
            const double solid_angle = 2 * pi / image.width * (std::cos(y * row) - std::cos((y + 1) * row));
            for (int x = 0; x < image.width; ++x) {
                const Rgba& pixel = image.at(x, y);
                integral = integral + solid_angle * Rgb{pixel.r, pixel.g, pixel.b};
            }
        }
        // Half a unit of the printed figures.
        const double rounding = expected.r > 10 ? 0.006 : 0.0006;
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(integral[c], expected[c], rounding) << name << " channel " << c;
    }
}

}  // namespace
}  // namespace searchlight
