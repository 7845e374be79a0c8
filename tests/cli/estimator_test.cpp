#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "program.h"

namespace searchlight {
namespace {

using nlohmann::json;

const std::string marble =
    "reference halfspace --sigma-a 0.0021 --sigma-s 2.19 --eta 1.5 --walks 1e4 --radii-max 2 --bins 10 --json";

// At equal walks the ratio of the errors is 0.42 to 0.48 here.
TEST_F(Program, TheBestEstimatorIsTheDefaultAndHasTheSmallerErrors) {
    const json best = json::parse(run(marble).out);
    const json plain = json::parse(run(marble + " --estimator analogue").out);
    EXPECT_EQ(best.at("estimator"), "best");
    EXPECT_EQ(plain.at("estimator"), "analogue");
    const auto error = [](const json& document) {
        return document.at("profile").at("stderr").at(0).at(5).get<double>();
    };
    EXPECT_LT(error(best), 0.8 * error(plain));
}

TEST_F(Program, TheAnalogueWalkServesGrids) {
    const Output output = run(marble + " --grid 4 --grid-extent 1");
    EXPECT_EQ(json::parse(output.out).at("estimator"), "analogue");
}

}  // namespace
}  // namespace searchlight
