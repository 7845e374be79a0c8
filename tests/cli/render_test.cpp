#include <nlohmann/json.hpp>

#include "base/files.h"
#include "io/image_file.h"
#include "program.h"

namespace searchlight {
namespace {

using nlohmann::json;

const std::string quick = "--size 48x32 --points 2000 --cache none ";

TEST_F(Program, SeveralParametersAreSetAtOnce) {
    writeFile(folder() / "a.brdf",
              "analytic\n::begin parameters\nfloat gloss 1 9 5\ncolor tint 1 .5 0\n::end parameters\n::begin shader\n"
              "vec3 BRDF(vec3 L, vec3 V, vec3 N, vec3 X, vec3 Y) { return tint * gloss; }\n::end shader\n");
    const Output output =
        run("render sphere --model directional_dipole --set Moments=exact,ClampNegative=0 --coat a.brdf "
            "--brdf-set gloss=2,tint=0,0,1 --print-job");
    ASSERT_EQ(output.exit_code, 0) << output.err;
    const json scene = json::parse(output.out).at("scene");
    EXPECT_EQ(scene.at("model").at("parameters"), json::parse(R"({"Moments": "exact", "ClampNegative": false})"));
    EXPECT_EQ(scene.at("coat").at("parameters"), json::parse(R"({"gloss": 2.0, "tint": [0.0, 0.0, 1.0]})"));
    EXPECT_EQ(run("render sphere --coat 0.2 --brdf-set gloss=2 --print-job").exit_code, 2);
    EXPECT_EQ(run("render sphere --coat a.brdf --brdf-set glos=2 --print-job").exit_code, 2);
}

TEST_F(Program, RendersAPictureThatSaysHowItWasMade) {
    const Output output =
        run("render sphere --scale 20 --material marble --light dir:1,1,1 --error 0.01 " + quick + "-o a.exr --json");
    ASSERT_EQ(output.exit_code, 0) << output.err;
    const json document = json::parse(output.out);
    EXPECT_EQ(document.at("format"), "searchlight-render/1");
    EXPECT_EQ(document.at("technique"), "hierarchical");
    EXPECT_EQ(document.at("points"), 2000);
    EXPECT_GT(document.at("receivers").get<int>(), 300);
    EXPECT_EQ(document.at("error"), 0.01);
    EXPECT_LE(document.at("error_bound").get<double>(), 0.01);
    EXPECT_FALSE(document.at("approximates").get<std::string>().empty());
    for (const char* stage :
         {"object", "rays", "points", "irradiance", "visible", "tree", "sum", "shade", "write", "total"})
        EXPECT_GE(document.at("ms").at(stage).get<double>(), 0) << stage;

    const ImageFile file = readImage((folder() / "a.exr").string());
    EXPECT_EQ(file.image.width, 48);
    EXPECT_EQ(file.image.height, 32);
    EXPECT_EQ(file.image.at(0, 0), (Rgba{0, 0, 0, 0}));
    EXPECT_EQ(file.image.at(24, 16).a, 1);
    EXPECT_GT(file.image.at(24, 16).g, 0);
    const std::map<std::string, std::string> metadata(file.metadata.begin(), file.metadata.end());
    EXPECT_EQ(metadata.at("technique"), "hierarchical");
    EXPECT_EQ(metadata.at("model"), "dipole");
    EXPECT_EQ(metadata.at("material"), "marble");
    EXPECT_EQ(json::parse(metadata.at("job")).at("command"), "render");
    EXPECT_EQ(fileCount(), 1u);
}

TEST_F(Program, FlagsAndASceneFileMeanTheSame) {
    const std::string flags =
        "torus_knot --scale 12 --material marble --model better_dipole --set Moments=exact --light dir:0,1,1 "
        "--light point:1,0,1 --irradiance 2,1,1 --sun-angle 3 --camera=-20,10,3 --fov 30 --target 0.1,0,0 --ground=0.1 "
        "--backdrop 0.1 --coat 0.2";
    const json job = json::parse(run("render " + flags + " --print-job").out);
    const json& scene = job.at("scene");
    EXPECT_EQ(scene.at("object"), "torus_knot");
    EXPECT_EQ(scene.at("scale"), 12);
    EXPECT_EQ(scene.at("model"), json::parse(R"({"id": "better_dipole", "parameters": {"Moments": "exact"}})"));
    EXPECT_EQ(scene.at("lights").size(), 2u);
    EXPECT_EQ(scene.at("lights").at(0).at("irradiance"), json({2, 1, 1}));
    EXPECT_EQ(scene.at("lights").at(0).at("angle_deg"), 3);
    EXPECT_EQ(scene.at("lights").at(1).at("intensity"), json({2, 1, 1}));
    EXPECT_EQ(scene.at("camera").at("azimuth_deg"), -20);
    EXPECT_EQ(scene.at("camera").at("distance"), 3);
    EXPECT_EQ(scene.at("camera").at("field_of_view_deg"), 30);
    EXPECT_EQ(scene.at("ground").at("height"), 0.1);
    EXPECT_EQ(scene.at("coat").at("roughness"), 0.2);
    EXPECT_EQ(scene.at("backdrop"), json({0.1, 0.1, 0.1}));

    writeFile(folder() / "scene.json", scene.dump());
    EXPECT_EQ(json::parse(run("render --scene scene.json --print-job").out), job);
    // It may stand where an object does, and then alone.
    EXPECT_EQ(json::parse(run("render scene.json --print-job").out), job);
    EXPECT_EQ(json::parse(run("contest scene.json --print-job").out).at("scene"), scene);
    EXPECT_EQ(run("render scene.json --scene scene.json --print-job").exit_code, 2);
    // A flag changes what the file says, and leaves the rest.
    const json changed = json::parse(run("render --scene scene.json --scale 5 --light none --print-job").out);
    EXPECT_EQ(changed.at("scene").at("scale"), 5);
    EXPECT_TRUE(changed.at("scene").at("lights").empty());
    EXPECT_EQ(changed.at("scene").at("camera"), scene.at("camera"));
}

TEST_F(Program, APictureIsTheSameForAnyNumberOfThreads) {
    for (const char* threads : {"1", "2"})
        ASSERT_EQ(run(std::string("render ") + quick + "--technique brute_force --threads " + threads + " -o " +
                      threads + ".pfm")
                      .exit_code,
                  0);
    EXPECT_EQ(readFile(folder() / "1.pfm"), readFile(folder() / "2.pfm"));
}

TEST_F(Program, PointsAreKeptForTheNextPicture) {
    const std::string arguments = "render --size 24x16 --points 2000 --cache kept -o ";
    ASSERT_EQ(run(arguments + "a.pfm").exit_code, 0);
    EXPECT_EQ(fileCount(), 2u);
    ASSERT_EQ(run(arguments + "b.pfm").exit_code, 0);
    EXPECT_EQ(fileCount(), 3u);
    EXPECT_EQ(readFile(folder() / "a.pfm"), readFile(folder() / "b.pfm"));
}

TEST_F(Program, AnInterruptedPictureExitsWith130AndLeavesNoFile) {
    const std::string command =
        "cd '" + folder().string() +
        "' && timeout -s INT 2 '" SEARCHLIGHT_PROGRAM
        "' render --model directional_dipole --technique brute_force --points 20000 --cache none "
        "-o a.exr >/dev/null 2>.err; [ $? -eq 124 ] && cat .err | grep -q interrupted; "
        "echo $? >code; rm .err";
    ASSERT_EQ(std::system(command.c_str()), 0);
    EXPECT_EQ(readFile(folder() / "code"), "0\n");
    EXPECT_EQ(fileCount(), 1u);
}

}  // namespace
}  // namespace searchlight
