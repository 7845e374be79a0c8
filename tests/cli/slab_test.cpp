#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "program.h"

namespace searchlight {
namespace {

using nlohmann::json;
using testing::HasSubstr;

constexpr const char* layers = R"({"format": "searchlight-layers/1", "layers": [
    {"n": 1.37, "sigma_a": 0.1, "sigma_s": 10, "g": 0.9, "thickness_mm": 1},
    {"n": 1.37, "sigma_a": 0.1, "sigma_s": 1, "thickness_mm": 1},
    {"n": 1.37, "sigma_a": 0.2, "sigma_s": 1, "g": 0.7, "thickness_mm": 2}]})";

constexpr const char* mci =
    "1.0\n1\nsample.mco A\n20000\n0.01 0.01\n40 50 2\n3\n1\n1.37 1 100 0.9 0.1\n1.37 1 10 0 0.1\n1.37 2 10 0.7 "
    "0.2\n1\n";

TEST_F(Program, ReferenceSlabHasItsParts) {
    writeFile(folder() / "layers.json", layers);
    const Output output = run("reference slab --layers layers.json --walks 1e6 --json");
    ASSERT_EQ(output.exit_code, 0) << output.err;
    const json slab = json::parse(output.out);
    EXPECT_EQ(slab.at("format"), "searchlight-slab/1");
    EXPECT_EQ(slab.at("per"), "incident");
    EXPECT_EQ(slab.at("walks"), 1000000);
    EXPECT_EQ(slab.at("layers").size(), 3u);
    // tests/data/transport/slabs.csv; five standard errors.
    const auto near = [&](const json& estimate, double truth) {
        EXPECT_NEAR(estimate.at("mean").get<double>(), truth, 5 * estimate.at("stderr").get<double>());
    };
    near(slab.at("R"), 0.237856252);
    near(slab.at("T"), 0.096046543);
    near(slab.at("A"), 0.641723150);
    EXPECT_EQ(slab.at("edges_mm").size(), 101u);
    for (const char* series : {"R_r", "R_r_single", "R_r_multiple", "T_r"})
        for (const char* list : {"mean", "stderr"}) EXPECT_EQ(slab.at(series).at(list).size(), 100u) << series;
    EXPECT_EQ(slab.at("R_a").at("mean").size(), 30u);
    EXPECT_EQ(slab.at("fluence_z").at("mean").size(), 100u);
    EXPECT_DOUBLE_EQ(slab.at("depth_mm").get<double>(), 4);
    EXPECT_FALSE(slab.contains("maps"));
}

TEST_F(Program, ASlabWithoutAnExactSolutionSaysWhy) {
    writeFile(folder() / "layers.json", layers);
    const auto refusal = [&](const std::string& options) {
        const Output output = run("reference slab --layers layers.json --exact " + options);
        EXPECT_EQ(output.exit_code, 2) << options;
        return output.err;
    };
    EXPECT_THAT(refusal("--angle-deg 30 --edges 0,1"),
                HasSubstr("no exact R(r) and T(r): the beam is oblique, 30 deg"));
    EXPECT_THAT(refusal("--walks 10"), HasSubstr("--exact and --walks exclude each other"));
    EXPECT_THAT(refusal("--until-error 1%"), HasSubstr("--exact and --until-error exclude each other"));
    EXPECT_THAT(refusal("--maps"), HasSubstr("--exact has no --maps"));
    EXPECT_THAT(refusal("--backend gl"), HasSubstr("--backend gl and --exact exclude each other"));
    writeFile(folder() / "sharp.json", R"({"format": "searchlight-layers/1", "layers": [
        {"n": 1.4, "sigma_a": 0.1, "sigma_s": 1, "g": 0.97, "thickness_mm": 1}]})");
    EXPECT_THAT(run("reference slab --layers sharp.json --exact").err, HasSubstr("|g| 0.97 is above 0.9"));
}

// Where R(r) has no exact solution the rest may have one.
TEST_F(Program, AnObliqueBeamThroughGlassHasExactTotalsAndAngles) {
    writeFile(folder() / "glass.json", R"({"format": "searchlight-layers/1", "layers": [
        {"n": 1.5, "sigma_a": 0, "sigma_s": 0, "thickness_mm": 1},
        {"n": 1.4, "sigma_a": 0.1, "sigma_s": 1, "thickness_mm": 1}]})");
    const std::string command = "reference slab --layers glass.json --angle-deg 30 --exact --angles 9";
    EXPECT_THAT(run(command).out, HasSubstr("no R(r) and T(r): the beam is oblique, 30 deg"));
    const json slab = json::parse(run(command + " --json").out);
    EXPECT_EQ(slab.at("estimator"), "exact");
    EXPECT_FALSE(slab.contains("R_r"));
    EXPECT_EQ(slab.at("R_a").at("mean").size(), 9u);
    double sum = slab.at("specular");
    for (const char* key : {"R", "R_unscattered", "T", "T_unscattered", "A"})
        sum += slab.at(key).at("mean").get<double>();
    EXPECT_NEAR(sum, 1, 1e-8);
}

TEST_F(Program, ReferenceSlabTakesGridAndPhotonsFromAnMciFileUnlessTold) {
    writeFile(folder() / "sample.mci", mci);
    json slab = json::parse(run("reference slab --mci sample.mci --json").out);
    EXPECT_EQ(slab.at("walks"), 20000);
    EXPECT_EQ(slab.at("edges_mm").size(), 51u);
    EXPECT_EQ(slab.at("depths"), 40);
    slab = json::parse(run("reference slab --mci sample.mci --walks 100 --angles 5 --angle-deg 60 --maps --json").out);
    EXPECT_EQ(slab.at("walks"), 100);
    EXPECT_EQ(slab.at("angles"), 5);
    EXPECT_EQ(slab.at("depths"), 40);
    EXPECT_EQ(slab.at("angle_deg"), 60);
    EXPECT_EQ(slab.at("maps").at("R_ra").at("mean").size(), 250u);
    EXPECT_EQ(slab.at("maps").at("A_rz").at("mean").size(), 2000u);
}

TEST_F(Program, McmlWritesTheFileThatTheRunNames) {
    writeFile(folder() / "sample.mci", mci);
    const Output output = run("mcml sample.mci");
    ASSERT_EQ(output.exit_code, 0) << output.err;
    EXPECT_THAT(output.out, HasSubstr("run 1 of 1: sample.mco"));
    EXPECT_THAT(output.out, HasSubstr("diffuse reflectance"));
    const std::string mco = readFile(folder() / "sample.mco");
    EXPECT_THAT(mco, testing::StartsWith("A1"));
    for (const char* block : {"InParm", "RAT", "A_l", "A_z", "Rd_r", "Rd_a", "Tt_r", "Tt_a", "A_rz", "Rd_ra", "Tt_ra"})
        EXPECT_THAT(mco, HasSubstr(std::string("\n") + block)) << block;
    EXPECT_EQ(fileCount(), 2u);
    const json document = json::parse(run("mcml sample.mci --walks 100 --json").out);
    EXPECT_EQ(document.at("runs").at(0).at("file"), "sample.mco");
    EXPECT_EQ(document.at("runs").at(0).at("walks"), 100);
}

TEST_F(Program, McmlWritesNothingWhenARunIsAtFault) {
    std::string bad = mci;
    bad[4] = '2';
    writeFile(folder() / "bad.mci", bad + "second.mco A\n10\n1 1\n1 1 1\n1\n1\n1.4 1 10 1 1\n1\n");
    const Output output = run("mcml bad.mci");
    EXPECT_EQ(output.exit_code, 3);
    EXPECT_EQ(output.err, "searchlight: bad.mci: run 2: g of layer 1 is 1 (above -1 and below 1)\n");
    EXPECT_EQ(fileCount(), 1u);
}

TEST_F(Program, HelpOfTheSlabCommandsShowsTheirExamples) {
    EXPECT_THAT(run("reference slab --help").out, HasSubstr("searchlight reference slab --layers layers.json"));
    EXPECT_THAT(run("mcml --help").out, HasSubstr("searchlight mcml sample.mci"));
}

TEST_F(Program, ASlabNeedsExactlyOneFile) {
    writeFile(folder() / "sample.mci", mci);
    const std::string hint = " (a .json or an .mci file that states its layers)\n";
    for (const char* arguments : {"reference slab", "reference slab --layers a.json --mci sample.mci"}) {
        const Output output = run(arguments);
        EXPECT_EQ(output.exit_code, 2) << arguments;
        EXPECT_EQ(output.err, "searchlight: a slab needs either --layers or --mci" + hint);
    }
    EXPECT_EQ(run("reference slab --mci sample.mci --run 2").err,
              "searchlight: sample.mci: no run 2: the file has 1\n");
    EXPECT_EQ(run("mcml missing.mci").exit_code, 3);
    EXPECT_EQ(run("mcml").exit_code, 2);
}

}  // namespace
}  // namespace searchlight
