#include "validate/profile_data.h"

#include "illegal/messages.h"

namespace searchlight {
namespace {

TEST(ProfileData, IllegalFilesAreAnsweredWordForWord) {
    expectMessages("profiles", [](std::string_view text, std::string_view path) { parseProfileData(text, path); });
}

TEST(ProfileData, ReadsPointsAnnuliAndErrors) {
    const ProfileData points =
        parseProfileData("# title: Wax\nr_mm,R,G,B\n0.5,3,2,1\n1,2,1,0.5\n2,1,0.5,0.1\n", "a.csv");
    EXPECT_EQ(points.title, "Wax");
    ASSERT_EQ(points.channels.size(), 3u);
    EXPECT_EQ(points.channels[1].value, (std::vector<double>{2, 1, 0.5}));
    EXPECT_TRUE(points.channels[1].edges_mm.empty() && points.channels[1].standard_error.empty());

    const ProfileData annuli =
        parseProfileData("r0_mm,r1_mm,R_d,R_d_stderr\n0,1,3,0.1\n1,3,2,0.2\n3,4,1,0.3\n", "a.csv");
    ASSERT_EQ(annuli.channels.size(), 1u);
    EXPECT_EQ(annuli.title, "a.csv");
    EXPECT_EQ(annuli.channels[0].edges_mm, (std::vector<double>{0, 1, 3, 4}));
    EXPECT_EQ(annuli.channels[0].radii_mm, (std::vector<double>{0.5, 2, 3.5}));
    EXPECT_EQ(annuli.channels[0].standard_error, (std::vector<double>{0.1, 0.2, 0.3}));
}

TEST(ProfileData, PerIncidentFluxIsDividedByWhatEnters) {
    // At 1.5 a normal beam loses 4 %.
    const ProfileData data = parseProfileData(
        "# per: incident\n# eta: 1.5\nr_mm,R_d,R_d_stderr\n1,0.96,0.0096\n2,0.48,0.0048\n3,0.24,0.0024\n", "a.csv");
    EXPECT_NEAR(data.channels[0].value[0], 1, 1e-14);
    EXPECT_NEAR(data.channels[0].standard_error[0], 0.01, 1e-16);
    EXPECT_EQ(data.eta, 1.5);
}

TEST(ProfileData, BetweenKeepsWholeAnnuli) {
    const ProfileData data = parseProfileData("r0_mm,r1_mm,R_d\n0,1,3\n1,2,2\n2,3,1\n3,4,0.5\n", "a.csv");
    const FitData part = between(data.channels[0], 0.5, 3);
    EXPECT_EQ(part.edges_mm, (std::vector<double>{1, 2, 3}));
    EXPECT_EQ(part.value, (std::vector<double>{2, 1}));
    EXPECT_EQ(between(data.channels[0], 0, 0).value.size(), 4u);
}

}  // namespace
}  // namespace searchlight
