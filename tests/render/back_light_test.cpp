#include "render/screen/back_light.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "back_light_case.h"
#include "light/transmitted_cosine.h"

namespace searchlight {
namespace {

using test::boxes;
using Case = test::BackLightCase;

constexpr Thickness all[] = {Thickness::nearest, Thickness::material, Thickness::outermost};
const DirectionalLight from_behind{.direction = {0, 0, -1}, .irradiance = {2, 2, 2}};

TEST(BackLight, ThroughASlabIsTheProfilesIntegralBeyondItsThickness) {
    Case slab(boxes({{0, 1.5f}}), 1.5f);
    // The integral of R_d((r^2 + s^2)^1/2) over the back: of exp(-r) it is 2 pi (1 + s) exp(-s).
    EXPECT_NEAR(slab.through(1.5).r, 2 * std::numbers::pi * 2.5 * std::exp(-1.5), 1e-4);
    for (const Thickness thickness : all) {
        const Rgb found = slab.light(thickness, from_behind);
        const Rgb expected = 2 * transmittedCosine(1, 1.3) * slab.through(1.5);
        EXPECT_NEAR(found.r, expected.r, 1e-4 * expected.r);  // rounding of the ray's way and of T12's table
        EXPECT_NEAR(found.g, expected.g, 1e-4 * expected.g);
        EXPECT_EQ(found.b, 0);
    }
    EXPECT_EQ(slab.light(Thickness::nothing, from_behind), (Rgb{}));
}

TEST(BackLight, ComesFromBehindOnly) {
    Case slab(boxes({{0, 1.5f}}), 1.5f);
    for (const Thickness thickness : all)
        EXPECT_EQ(slab.light(thickness, DirectionalLight{.direction = {0.1, 0, 1}}), (Rgb{}));
}

TEST(BackLight, SlantedLightGoesItsOwnWay) {
    Case slab(boxes({{0, 1.5f}}), 1.5f);
    const double cosine = std::sqrt(0.5);
    const Rgb found = slab.light(Thickness::nearest, DirectionalLight{.direction = {1, 0, -1}});
    const double expected = transmittedCosine(cosine, 1.3) * slab.through(1.5 / cosine).r;
    EXPECT_NEAR(found.r, expected, 1e-4 * expected);
}

TEST(BackLight, APointIsBrighterWhereItIsNear) {
    Case slab(boxes({{0, 1.5f}}), 1.5f);
    slab.visible.positions = {{0, 0, 1.5f}};
    // Half a longest side, 20 mm, behind the object's centre: four times the light of one longest side.
    const Rgb found = slab.light(Thickness::nearest, PointLight{.position = {0, 0, -0.5}});
    const Rgb expected = 4 * transmittedCosine(1, 1.3) * slab.through(1.5);
    EXPECT_NEAR(found.r, expected.r, 1e-4 * expected.r);
}

// [Freude2014] Fig. 6.27: the light falls onto something else first. A shadow map sees one thick object.
TEST(BackLight, GapsAreNoMaterial) {
    Case two(boxes({{-10, -9.5f}, {0, 1.5f}}), 1.5f);
    const double t12 = 2 * transmittedCosine(1, 1.3);
    EXPECT_NEAR(two.light(Thickness::outermost, from_behind).r, t12 * two.through(11.5).r, 1e-3 * two.through(11.5).r);
    EXPECT_NEAR(two.light(Thickness::material, from_behind).r, t12 * two.through(2).r, 1e-3 * two.through(2).r);
    // The back of the nearer one lies in shadow.
    EXPECT_EQ(two.light(Thickness::nearest, from_behind), (Rgb{}));
}

}  // namespace
}  // namespace searchlight
