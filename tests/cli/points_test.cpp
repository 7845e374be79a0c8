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

TEST_F(Program, MeshGetsAnAtlasThatIsReadBack) {
    const Output written = run("mesh torus_knot --atlas 128 --uvs own --picture charts.png -o knot.obj --json");
    ASSERT_EQ(written.exit_code, 0) << written.err;
    const json atlas = json::parse(written.out).at("atlas");
    EXPECT_FALSE(atlas.at("from_file"));
    EXPECT_LT(atlas.at("stretch_l2"), 1.1);
    EXPECT_TRUE(std::filesystem::exists(folder() / "charts.png"));
    const Output again = run("mesh knot.obj --atlas 128 --uvs file --json");
    ASSERT_EQ(again.exit_code, 0) << again.err;
    EXPECT_EQ(json::parse(again.out).at("atlas").at("charts"), atlas.at("charts"));
    const Output none = run("mesh torus_knot --picture charts.png");
    EXPECT_EQ(none.exit_code, 2);
    EXPECT_THAT(none.err, HasSubstr("--atlas 256 makes one"));
}

TEST_F(Program, RendersInTextureSpaceAndReportsTheAtlas) {
    const Output written = run(
        "render torus_knot --technique texture-space --samples 400 --atlas 64 --uvs own --size 48x32 -o a.exr --json");
    ASSERT_EQ(written.exit_code, 0) << written.err;
    const json document = json::parse(written.out);
    EXPECT_EQ(document.at("technique"), "texture-space");
    EXPECT_GT(document.at("charts"), 1);
    EXPECT_GT(document.at("atlas_fill"), 0.3);
    EXPECT_TRUE(document.at("error_bound").is_null());
    const Output refused = run("render sphere --technique separable --atlas 64 --size 48x32 -o b.exr");
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_THAT(refused.err, HasSubstr("it belongs to --technique texture-space"));
}

}  // namespace
}  // namespace searchlight
