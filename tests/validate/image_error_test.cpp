#include "validate/image_error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "base/error.h"
#include "base/srgb.h"
#include "validate/ssim.h"
#include "validate/test_pictures.h"

namespace searchlight {
namespace {

Image constant(float value, int size = 32) { return Image(size, size, {value, value, value, 1}); }

std::string message(const std::function<void()>& act) {
    try {
        act();
    } catch (const Error& error) {
        return error.what();
    }
    return "no error";
}

TEST(ImageError, OfAPictureWithItselfIsNone) {
    const Image image = rings(40, 30);
    const ImageError error = compareImages(image, image);
    EXPECT_EQ(error.rmse, 0);
    EXPECT_EQ(error.relative_rmse, 0);
    EXPECT_EQ(error.mean_difference, 0);
    EXPECT_EQ(error.largest, 0);
    EXPECT_NEAR(error.ssim, 1, 1e-6);  // its means are sums in float
    EXPECT_EQ(error.flip, 0);
    EXPECT_EQ(error.pixels, 40u * 30);
}

TEST(ImageError, OfAConstantShiftHasClosedForms) {
    const ImageError error = compareImages(constant(0.6f), constant(0.5f));
    EXPECT_NEAR(error.rmse, 0.1, 1e-7);
    EXPECT_NEAR(error.relative_rmse, 0.2, 1e-7);
    EXPECT_NEAR(error.mean_difference, 0.2, 1e-7);
    EXPECT_NEAR(error.largest, 0.1, 1e-7);
    EXPECT_NEAR(compareImages(constant(0.4f), constant(0.5f)).mean_difference, -0.2, 1e-7);
    // Without variance SSIM is (2 a b + C1) / (a^2 + b^2 + C1); 5e-5: its variances are differences of floats
    // of 2e3, beside C2 = 59.
    const double a = pu21(60), b = pu21(50), c1 = std::pow(0.01 * pu21(100), 2);
    EXPECT_NEAR(error.ssim, (2 * a * b + c1) / (a * a + b * b + c1), 5e-5);
}

TEST(ImageError, CountsWhatTheReferenceCovers) {
    Image reference = constant(0.5f), image = constant(0.5f);
    for (int x = 0; x < 32; ++x) {
        reference.at(x, 0) = {0, 0, 0, 0};
        image.at(x, 0) = {9, 9, 9, 1};
    }
    image.at(5, 5) = {1, 0.5f, 0.5f, 1};
    const ImageError error = compareImages(image, reference);
    EXPECT_EQ(error.pixels, 31u * 32);
    EXPECT_EQ(error.largest, 0.5);
    EXPECT_NEAR(error.rmse, std::sqrt(0.25 / (3 * 31 * 32)), 1e-9);
}

// PU21 was fitted such that 100 cd/m^2 is near 256, and codes of 0.005 and 10000 cd/m^2 are near 0 and 596
// [MantiukAzimi2021].
TEST(Ssim, PerceivedCodesArePublishedOnes) {
    EXPECT_NEAR(pu21(100), 256, 0.5);
    EXPECT_NEAR(pu21(0.005), 0, 0.5);
    EXPECT_NEAR(pu21(10000), 595.4, 1);
    EXPECT_EQ(pu21(-1), pu21(0.005));
}

// Means by the FLIP of [Andersson2020]'s authors (github.com/NVlabs/flip, C++) for the same pictures; per
// pixel, its single precision and ours differ by 4e-6 on these.
TEST(Flip, AgreesWithItsAuthors) {
    EXPECT_NEAR(compareImages(alteredRings(96, 64), rings(96, 64)).flip, 0.2632851, 2e-6);
    EXPECT_NEAR(compareImages(alteredRings(640, 400), rings(640, 400)).flip, 0.2401886, 2e-6);
}

TEST(Flip, OfTheFarthestColoursIsOne) {
    EXPECT_NEAR(compareImages(Image(32, 32, {0, 1, 0, 1}), Image(32, 32, {0, 0, 1, 1})).flip, 1, 1e-6);
    // Black and white differ in lightness alone, by 100; green and blue by 203.3 in HyAB after the Hunt effect: 0.95 +
    // 0.05 (100^0.7 / 203.3^0.7 - 0.4) / 0.6.
    EXPECT_NEAR(compareImages(constant(0), constant(1)).flip, 0.95 + 0.05 / 0.6 * (std::pow(100 / 203.3, 0.7) - 0.4),
                0.001);
}

TEST(Flip, SeesTheExposureAsked) {
    const Image dim = constant(0.25f), dimmer = constant(0.2f);
    EXPECT_NEAR(compareImages(dim, dimmer, {.exposure = 1}).flip, compareImages(constant(0.5f), constant(0.4f)).flip,
                1e-6);
    EXPECT_EQ(compareImages(constant(3), constant(2)).flip, 0) << "both are white on a display";
}

TEST(DifferenceImage, ShowsSizeAndSign) {
    const Image reference = constant(0.5f);
    const Image none = differenceImage(reference, reference);
    EXPECT_EQ(none.at(0, 0), (Rgba{0, 0, 0, 1}));
    const Image full = differenceImage(constant(1), reference);
    EXPECT_EQ(full.at(0, 0), (Rgba{1, 1, 1, 1})) << "a difference of the mean is the scale's end";
    EXPECT_EQ(differenceImage(constant(0), reference).at(3, 3), full.at(0, 0)) << "unsigned";
    const Rgba bright = differenceImage(constant(0.7f), reference, {.is_signed = true}).at(0, 0);
    const Rgba dark = differenceImage(constant(0.3f), reference, {.is_signed = true}).at(0, 0);
    EXPECT_GT(bright.r, bright.b) << "orange";
    EXPECT_GT(dark.b, dark.r) << "blue";
}

// Larger differences are lighter, whatever the sign.
TEST(DifferenceImage, LightnessRises) {
    for (const bool is_signed : {false, true}) {
        for (const float sign : {-1.f, 1.f}) {
            double last = -1;
            for (float step = 0; step <= 0.5f; step += 1 / 64.f) {
                const Rgba p =
                    differenceImage(constant(0.5f + sign * step, 1), constant(0.5f, 1), {.is_signed = is_signed})
                        .at(0, 0);
                const double y = luminance(Rgb{p.r, p.g, p.b});
                EXPECT_GE(y, last) << is_signed << " " << sign * step;
                last = y;
            }
        }
    }
}

TEST(ImageError, RefusesWhatCannotBeCompared) {
    EXPECT_EQ(message([] { compareImages(constant(1, 4), constant(1, 5)); }),
              "the picture is 4 x 4 pixels, its reference 5 x 5 (both have to be of one size)");
    EXPECT_EQ(message([] { compareImages(constant(1, 4), Image(4, 4)); }),
              "the reference covers no pixel (expected alpha above 0 somewhere)");
    EXPECT_EQ(message([] { compareImages(constant(1, 4), constant(0, 4)); }),
              "the reference is black where it covers (errors are relative to its mean)");
    Image broken = constant(1, 4);
    broken.at(2, 1).g = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(message([&] { compareImages(broken, constant(1, 4)); }),
              "the picture has a value at (2, 1) that is infinite or not a number");
    EXPECT_EQ(message([&] { differenceImage(constant(1, 4), broken); }),
              "the reference has a value at (2, 1) that is infinite or not a number");
}

}  // namespace
}  // namespace searchlight
