#include "scene/medium.h"

#include <limits>

#include "base/error.h"

namespace searchlight {
namespace {

std::string messageOf(const Medium& medium) {
    try {
        checkMedium(medium);
    } catch (const Error& error) {
        return error.what();
    }
    return "no error";
}

const Medium skin{{0.1, 0.2, 0.3}, {1, 2, 3}, {0.5, 0, -0.5}, 1.4, 3};

TEST(Medium, DerivedCoefficientsFollowTheirDefinitions) {
    EXPECT_EQ(skin.sigmaSp(), (Rgb{0.5, 2, 4.5}));
    EXPECT_EQ(skin.sigmaTp(), (Rgb{0.6, 2.2, 4.8}));
    EXPECT_EQ(skin.sigmaT(), (Rgb{1.1, 2.2, 3.3}));
    EXPECT_DOUBLE_EQ(skin.alphaPrime().g, 2 / 2.2);
}

TEST(Medium, ChannelWithoutScatteringIsNotApplicable) {
    Medium wine = skin;
    wine.sigma_s.g = 0;
    EXPECT_TRUE(wine.scatters(0));
    EXPECT_FALSE(wine.scatters(1));
    EXPECT_EQ(messageOf(wine), "no error");
}

TEST(Medium, ImpossibleNumbersAreNamedWithTheirChannel) {
    const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
    Medium bad = skin;
    bad.sigma_a.g = -0.5;
    EXPECT_EQ(messageOf(bad), "sigma_a is -0.5 in the green channel (expected a finite number of at least 0 1/mm)");
    bad = skin;
    bad.sigma_s.b = inf;
    EXPECT_EQ(messageOf(bad), "sigma_s is inf in the blue channel (expected a finite number of at least 0 1/mm)");
    bad = skin;
    bad.g.r = nan;
    EXPECT_EQ(messageOf(bad), "g is nan in the red channel (expected a mean cosine above -1 and below 1)");
    bad = skin;
    bad.sigma_a.r = bad.sigma_s.r = 0;
    EXPECT_EQ(messageOf(bad), "sigma_a and sigma_s are both 0 in the red channel (a medium absorbs or scatters)");
}

TEST(Medium, SingleChannelIsNotNamed) {
    Medium bad{{1, 1, 1}, {1, 1, 1}, {-1, -1, -1}, 1, 1};
    EXPECT_EQ(messageOf(bad), "g is -1 (expected a mean cosine above -1 and below 1)");
}

TEST(Medium, IndexIsBetweenAQuarterAndFour) {
    Medium medium = skin;
    for (const double eta : {0.25, 1.0, 4.0}) {
        medium.eta = eta;
        EXPECT_EQ(messageOf(medium), "no error") << eta;
    }
    medium.eta = 4.001;
    EXPECT_EQ(messageOf(medium), "eta is 4.001 (expected a refractive index from 0.25 to 4, inside over outside)");
    medium.eta = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(messageOf(medium), "eta is nan (expected a refractive index from 0.25 to 4, inside over outside)");
}

TEST(Medium, OneNumberEachMakesOneChannelAndAnyTripleMakesThree) {
    EXPECT_EQ(makeMedium({0.1}, {2}, {0}, 1.3).channels, 1);
    const Medium three = makeMedium({0.1}, {1, 2, 3}, {0}, 1.3);
    EXPECT_EQ(three.channels, 3);
    EXPECT_EQ(three.sigma_a, (Rgb{0.1, 0.1, 0.1}));
    EXPECT_EQ(three.sigma_s, (Rgb{1, 2, 3}));
    EXPECT_THROW(makeMedium({0.1, 0.2}, {1}, {0}, 1.3), Error);
    EXPECT_THROW(makeMedium({}, {1}, {0}, 1.3), Error);
    EXPECT_THROW(makeMedium({-0.1}, {1}, {0}, 1.3), Error);
}

TEST(Medium, ScaleStretchesMeanFreePathsAndNothingElse) {
    const Medium larger = scaled(skin, 4);
    EXPECT_EQ(larger.sigma_a, (Rgb{0.025, 0.05, 0.075}));
    EXPECT_EQ(larger.sigma_s, (Rgb{0.25, 0.5, 0.75}));
    EXPECT_EQ(larger.g, skin.g);
    EXPECT_EQ(larger.eta, skin.eta);
    for (const double scale : {0.0, -1.0, std::numeric_limits<double>::infinity()})
        EXPECT_THROW(scaled(skin, scale), Error) << scale;
}

}  // namespace
}  // namespace searchlight
