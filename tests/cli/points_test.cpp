#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "program.h"

namespace searchlight {
namespace {

using nlohmann::json;
using testing::HasSubstr;

TEST_F(Program, PointsAreMadeOnceAndThenRead) {
    const std::string arguments = "points torus_knot -n 2000 --cache kept --seed 3 -o cloud.ptc --json";
    const Output first = run(arguments), second = run(arguments);
    ASSERT_EQ(first.exit_code, 0) << first.err;
    const json made = json::parse(first.out).at("points"), read = json::parse(second.out).at("points");
    EXPECT_EQ(made.at("count"), 2000);
    EXPECT_EQ(made.at("unit"), "the mesh's own");
    EXPECT_FALSE(made.at("cached"));
    EXPECT_TRUE(read.at("cached"));
    // The file has its areas as floats.
    EXPECT_NEAR(made.at("area_error"), 0, 1e-6);
    EXPECT_TRUE(std::filesystem::exists(folder() / "cloud.ptc"));
}

TEST_F(Program, MeshReportsAndConverts) {
    const Output written = run("mesh torus_knot -o knot.obj --json");
    ASSERT_EQ(written.exit_code, 0) << written.err;
    const json knot = json::parse(written.out).at("mesh");
    EXPECT_TRUE(knot.at("closed"));
    EXPECT_EQ(knot.at("genus"), 1);
    const Output again = run("mesh knot.obj --json");
    ASSERT_EQ(again.exit_code, 0) << again.err;
    EXPECT_EQ(json::parse(again.out).at("mesh").at("triangles"), knot.at("triangles"));
    const Output unknown = run("mesh nowhere.obj");
    EXPECT_EQ(unknown.exit_code, 3);
    EXPECT_THAT(unknown.err, HasSubstr("nowhere.obj: no such file"));
}

}  // namespace
}  // namespace searchlight
