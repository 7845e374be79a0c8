#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "program.h"

namespace searchlight {
namespace {

using nlohmann::json;

const std::string matched = "reference halfspace --sigma-a 0.1 --sigma-s 0.9 --eta 1 --edges 0,0.5,1,2,5 --json";

TEST_F(Program, ExactReferenceHasTheKeysOfAWalkedOne) {
    const json exact = json::parse(run(matched + " --exact").out),
               walked = json::parse(run(matched + " --walks 1e5").out);
    for (const auto& [key, value] : walked.items()) EXPECT_TRUE(exact.contains(key)) << key;
    EXPECT_EQ(exact.at("estimator"), "exact");
    EXPECT_EQ(exact.at("walks"), 0);
    EXPECT_GT(exact.at("seconds").get<double>(), 0);
    EXPECT_EQ(exact.at("job").at("options").at("exact"), true);
    // From the H function, 14 digits.
    EXPECT_NEAR(exact.at("diffuse").at("mean").at(0).get<double>(), 0.41494747913082, 1e-13);
    for (int i = 0; i < 4; ++i) {
        const double truth = exact.at("profile").at("Rd").at(0).at(i),
                     bound = exact.at("profile").at("stderr").at(0).at(i);
        const double mean = walked.at("profile").at("Rd").at(0).at(i),
                     error = walked.at("profile").at("stderr").at(0).at(i);
        EXPECT_GT(bound, 0);
        EXPECT_LT(bound, 1e-12 * truth);
        EXPECT_NEAR(mean, truth, 4 * error);  // 1 in 4000 seeds would miss; this one is fixed
    }
}

TEST_F(Program, AToggleStandsAloneOrTakesAValue) {
    const json alone = json::parse(run(matched + " --exact").out);
    for (const char* given : {" --exact true", " --exact=on"})
        EXPECT_EQ(json::parse(run(matched + given).out).at("profile"), alone.at("profile")) << given;
    EXPECT_EQ(json::parse(run(matched + " --walks 10 --exact false").out).at("estimator"), "best");
    // Before another option.
    EXPECT_EQ(
        json::parse(run("reference halfspace --exact --sigma-a 0.1 --sigma-s 0.9 --eta 1 --json").out).at("walks"), 0);
}

TEST_F(Program, ExactReferenceTreatsEveryChannel) {
    const Output output = run("reference halfspace --sigma-a 0,0.1,1 --sigma-s 1,0,0.9 --eta 1 --exact");
    EXPECT_EQ(output.exit_code, 0) << output.err;
    EXPECT_THAT(output.out, testing::HasSubstr("R     0.000000  "));
    EXPECT_THAT(output.out, testing::HasSubstr("G    not applicable"));
    EXPECT_THAT(output.out, testing::HasSubstr("0.10616"));
}

TEST_F(Program, AlbedoPlotHasTheExactCurveWithoutWalks) {
    ASSERT_EQ(run("plot albedo --models dipole --eta 1 -o matched.svg").exit_code, 0);
    EXPECT_THAT(readFile(folder() / "matched.svg"), testing::HasSubstr("exact (H-function)"));
    ASSERT_EQ(run("plot albedo --models dipole --eta 1.3 -o refracting.svg").exit_code, 0);
    EXPECT_THAT(readFile(folder() / "refracting.svg"), testing::Not(testing::HasSubstr("H-function")));
}

}  // namespace
}  // namespace searchlight
