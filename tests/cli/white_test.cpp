#include <nlohmann/json.hpp>

#include "program.h"

namespace searchlight {
namespace {

using nlohmann::json;

class White : public Program {
protected:
    void SetUp() override {
        Program::SetUp();
        setenv("XDG_CACHE_HOME", folder().c_str(), 1);
    }
    void TearDown() override {
        unsetenv("XDG_CACHE_HOME");
        Program::TearDown();
    }
};

constexpr const char* problem =
    "reference halfspace --sigma-a 0.1 --sigma-s 1,2,3 --g 0.3 --eta 1.3 --walks 2e4 --radii-max 4 --bins 8 --json";

TEST_F(White, HasTheShapeOfAWalkAndSaysWhereItsTableCameFrom) {
    const json walked = json::parse(run(problem).out), white = json::parse(run(std::string(problem) + " --white").out);
    for (const auto& [key, value] : walked.items()) EXPECT_TRUE(white.contains(key)) << key;
    EXPECT_EQ(white.at("profile").at("edges_mm"), walked.at("profile").at("edges_mm"));
    EXPECT_EQ(white.at("specular"), walked.at("specular"));
    EXPECT_EQ(white.at("estimator"), "white");
    EXPECT_FALSE(walked.contains("white"));
    EXPECT_EQ(white.at("white").at("largest_albedo"), 0.9999);
    ASSERT_EQ(white.at("white").at("tables").size(), 3u);
    EXPECT_EQ(white.at("white").at("tables").at(0).at("cache_hit"), false);
    EXPECT_EQ(fileCount(), 1u) << "channels of one g share a table";
    // Both are known to 2 %; far enough from each other and from 0 to tell the channels apart.
    for (std::size_t c = 0; c < 3; ++c) {
        const double a = walked.at("diffuse").at("mean").at(c), b = white.at("diffuse").at("mean").at(c);
        EXPECT_NEAR(a, b,
                    5 * (walked.at("diffuse").at("stderr").at(c).get<double>() +
                         white.at("diffuse").at("stderr").at(c).get<double>()));
    }
}

TEST_F(White, NewCoefficientsNeedNoNewWalk) {
    run(std::string(problem) + " --white");
    const json other = json::parse(
        run("reference halfspace --sigma-a 1 --sigma-s 1 --g 0.3 --eta 1.3 --walks 2e4 --radii-max 4 --white --json")
            .out);
    EXPECT_EQ(other.at("white").at("tables").at(0).at("cache_hit"), true);
    EXPECT_EQ(fileCount(), 1u);
    run("reference halfspace --sigma-a 1 --sigma-s 1 --g 0.4 --eta 1.3 --walks 2e4 --radii-max 4 --white");
    EXPECT_EQ(fileCount(), 2u);
}

TEST_F(White, AReferenceWalksUnlessItIsAskedFor) {
    EXPECT_EQ(json::parse(run(problem).out).at("estimator") == "white", false);
    EXPECT_EQ(fileCount(), 0u);
}

TEST_F(White, WhatATableCannotAnswerIsRefused) {
    for (const char* more : {"--exact", "--grid 4 --grid-extent 1", "--estimator analogue"}) {
        const Output output = run(std::string(problem) + " --white " + more);
        EXPECT_EQ(output.exit_code, 2) << more;
        EXPECT_NE(output.err.find("--white"), std::string::npos) << output.err;
    }
    const Output output = run("reference halfspace --white --sigma-a 0 --sigma-s 1 --walks 100");
    EXPECT_EQ(output.exit_code, 3);
    EXPECT_NE(output.err.find("up to 0.9999"), std::string::npos) << output.err;
}

}  // namespace
}  // namespace searchlight
