// Pictures of the radiance that leaves a body.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "program.h"

namespace searchlight {
namespace {

using nlohmann::json;
using testing::HasSubstr;

const std::string sphere = "reference sphere --material skin1 --radius 2 --size 16x16 --radiance --json --seed 3 ";

TEST_F(Program, ARadianceReferenceOfTheSunHasItsErrors) {
    const Output output = run(sphere + "--light dir:1,1,1 --sun-angle 30 --walks 4e4 -o sphere.exr");
    ASSERT_EQ(output.exit_code, 0) << output.err;
    const json document = json::parse(output.out);
    EXPECT_EQ(document["estimator"], "radiance, analogue");
    for (std::size_t c = 0; c < 3; ++c) {
        EXPECT_GT(document["mean_radiance"][c], 0);
        EXPECT_GT(document["mean_radiance_stderr"][c], 0);
        EXPECT_EQ(document["walks"][c].get<int>() % 256, 0) << "as many for every pixel";
    }
    const std::string picture = readFile(folder() / "sphere.exr");
    EXPECT_THAT(picture, HasSubstr("stderr.R"));
    EXPECT_THAT(picture, HasSubstr("radiance reference"));
}

TEST_F(Program, AResumedRadianceReferenceAddsToWhatThereIs) {
    const std::string sun = sphere + "--light dir:1,1,1 --sun-angle 30 ";
    const json straight = json::parse(run(sun + "--walks 1048576").out);
    ASSERT_EQ(run(sun + "--walks 524288 --resume walks.json").exit_code, 0);
    const Output second = run(sun + "--walks 1048576 --resume walks.json");
    ASSERT_EQ(second.exit_code, 0) << second.err;
    const json resumed = json::parse(second.out);
    EXPECT_EQ(resumed["walks"], straight["walks"]);
    // Chunks of the shorter job were smaller, so that the walks are others.
    for (std::size_t c = 0; c < 3; ++c)
        EXPECT_NEAR(resumed["mean_radiance"][c].get<double>(), straight["mean_radiance"][c].get<double>(),
                    5 * 1.42 * straight["mean_radiance_stderr"][c].get<double>());
}

TEST_F(Program, ARadianceReferenceOfLightThatNoWalkMeetsAsksForIt) {
    const Output sun = run(sphere + "--light dir:1,1,1 --walks 1e4");
    ASSERT_EQ(sun.exit_code, 0) << sun.err;
    const json document = json::parse(sun.out);
    EXPECT_EQ(document["estimator"], "radiance, beams at collisions");
    for (std::size_t c = 0; c < 3; ++c) {
        EXPECT_GT(document["mean_radiance"][c].get<double>(), 5 * document["mean_radiance_stderr"][c].get<double>());
        EXPECT_EQ(document["mirrored"][c], 0);
    }
    const Output error = run(sphere + "--light dir:1,1,1 --sun-angle 30 --walks 1e3 --until-error 1%");
    EXPECT_EQ(error.exit_code, 2);
}

}  // namespace
}  // namespace searchlight
