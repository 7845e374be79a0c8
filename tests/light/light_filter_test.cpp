#include "light/light_filter.h"

#include <cmath>

#include "base/error.h"

namespace searchlight {
namespace {

// Red above left, green above right, blue below left, white below right.
Image fourPanes() {
    Image picture(2, 2);
    picture.at(0, 0) = {1, 0, 0, 1}, picture.at(1, 0) = {0, 1, 0, 1};
    picture.at(0, 1) = {0, 0, 1, 1}, picture.at(1, 1) = {1, 1, 1, 1};
    return picture;
}

constexpr double radius = 4;  // so a pane is 4 mm wide and its centre 2 mm from the axis

TEST(LightFilter, IsUprightForWhoLooksAlongTheLight) {
    // Light from +z: who looks along it, towards -z, has +x to the right.
    const LightFilter front(fourPanes(), "panes.png", {0, 0, 1}, radius);
    EXPECT_EQ(front({-2, 2, 7}, 0), (Rgb{1, 0, 0}));
    EXPECT_EQ(front({2, 2, -7}, 0), (Rgb{0, 1, 0}));
    EXPECT_EQ(front({-2, -2, 0}, 0), (Rgb{0, 0, 1}));
    EXPECT_EQ(front({2, -2, 0}, 0), (Rgb{1, 1, 1}));
    // From the other side left and right change places.
    const LightFilter back(fourPanes(), "panes.png", {0, 0, -3}, radius);
    EXPECT_EQ(back({2, 2, 0}, 0), (Rgb{1, 0, 0}));
    // From +x, looking towards -x, -z is to the right.
    const LightFilter side(fourPanes(), "panes.png", {5, 0, 0}, radius);
    EXPECT_EQ(side({0, 2, -2}, 0), (Rgb{0, 1, 0}));
    // Straight down the picture's top points to -z.
    const LightFilter above(fourPanes(), "panes.png", {0, 1, 0}, radius);
    EXPECT_EQ(above({-2, 0, -2}, 0), (Rgb{1, 0, 0}));
    EXPECT_EQ(above({2, 0, -2}, 0), (Rgb{0, 1, 0}));
    // And straight up to +z; to the right is +x again.
    const LightFilter below(fourPanes(), "panes.png", {0, -1, 0}, radius);
    EXPECT_EQ(below({-2, 0, 2}, 0), (Rgb{1, 0, 0}));
}

TEST(LightFilter, ColoursGlassAndLeavesHolesOpen) {
    Image picture(2, 1);
    picture.at(0, 0) = {0, 0, 0, 0};         // nothing there
    picture.at(1, 0) = {0.25f, 0, 0, 0.5f};  // half covered by red glass that passes half
    const LightFilter filter(picture, "glass.png", {0, 0, 1}, radius);
    // The shorter side, one pixel, spans the sphere: pixel centres lie 4 mm from the axis.
    EXPECT_EQ(filter({-4, 0, 0}, 0), (Rgb{1, 1, 1}));
    EXPECT_EQ(filter({4, 0, 0}, 0), (Rgb{0.75, 0.5, 0.5}));
}

TEST(LightFilter, AveragesOverTheWidthThatAPointStandsFor) {
    Image picture(64, 64);
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) {
            const float value = static_cast<float>((x + y) % 2);
            picture.at(x, y) = {value, value, value, 1};
        }
    const LightFilter filter(picture, "checker.png", {0, 0, 1}, radius);
    const double pixel = 2 * radius / 64;
    EXPECT_EQ(filter({0.5 * pixel, 0.5 * pixel, 0}, 0).r, 1);  // column 32, row 31
    EXPECT_EQ(filter({1.5 * pixel, 0.5 * pixel, 0}, 0).r, 0);
    EXPECT_NEAR(filter({1.3, -0.7, 0}, 2 * pixel).r, 0.5, 1e-6);
    EXPECT_NEAR(filter({1.3, -0.7, 0}, 1000).r, 0.5, 1e-6);
}

TEST(LightFilter, OfAnOddSizeKeepsItsMeanAndItsPlace) {
    Image picture(7, 5, {0, 0, 0, 1});
    picture.at(3, 2) = {35, 35, 35, 1};  // in the middle; mean 1
    const LightFilter filter(picture, "dot.png", {0, 0, 1}, radius);
    EXPECT_NEAR(filter({0, 0, 0}, 1e9).g, 1, 1e-5);
    EXPECT_NEAR(filter({0.9, 0, 0}, 3).g, filter({-0.9, 0, 0}, 3).g, 1e-4);
}

TEST(LightFilter, RefusesWhatIsNoNumber) {
    Image picture(1, 1, {NAN, 0, 0, 1});
    try {
        LightFilter(picture, "glass.png", {0, 0, 1}, radius);
        FAIL();
    } catch (const Error& error) {
        EXPECT_STREQ(error.what(),
                     "glass.png: pixel 0, 0 is infinite or not a number: no light (counted from the top left, from 0)");
    }
}

}  // namespace
}  // namespace searchlight
