// convert and fit as they are typed.
#include <nlohmann/json.hpp>

#include "program.h"

namespace searchlight {
namespace {

using nlohmann::json;

std::string listText(const json& list) {
    std::string text;
    for (const json& value : list) {
        if (!text.empty()) text += ',';
        text += value.dump();
    }
    return text;
}

TEST_F(Program, ConvertsThereAndBack) {
    const json there = json::parse(run("convert --from jensen --material skin1 --to unreal --json").out);
    EXPECT_EQ(there.at("format"), "searchlight-conversion/1");
    const json& unreal = there.at("to").at(0);
    EXPECT_EQ(unreal.at("convention"), "unreal");
    EXPECT_LT(unreal.at("read_back_error").get<double>(), 1e-9);
    const json& values = unreal.at("values");
    EXPECT_EQ(values.at("mean_free_path_distance").at("unit"), "cm");
    EXPECT_FALSE(values.at("mean_free_path_distance").at("meaning").get<std::string>().empty());
    const json back =
        json::parse(run("convert --from unreal --to physical --json --surface-albedo " +
                        listText(values.at("surface_albedo").at("value")) + " --mean-free-path-color " +
                        listText(values.at("mean_free_path_color").at("value")) + " --mean-free-path-distance " +
                        values.at("mean_free_path_distance").at("value").dump())
                        .out);
    const double sigma_a[] = {0.032, 0.17, 0.48}, sigma_s[] = {0.74, 0.88, 1.01};
    for (std::size_t c = 0; c < 3; ++c) {
        EXPECT_NEAR(back.at("medium").at("sigma_a").at(c).get<double>() / sigma_a[c], 1, 1e-9);
        EXPECT_NEAR(back.at("medium").at("sigma_s").at(c).get<double>() / sigma_s[c], 1, 1e-9);
    }
}

TEST_F(Program, WhatCannotBeSaidIsNullWithANote) {
    const json document = json::parse(run("convert --material marble --to chiang --json").out);
    EXPECT_TRUE(document.at("to").at(0).at("values").at("A").at("value").at(0).is_null());
    EXPECT_TRUE(document.at("to").at(0).at("read_back_error").is_null());
    EXPECT_THAT(document.at("to").at(0).at("notes").at(0).get<std::string>(),
                testing::HasSubstr("the fit ends at 0.998886"));
}

TEST_F(Program, FitsWhatProfileAndReferenceWrite) {
    ASSERT_EQ(run("profile --model dipole --material skin1 -o skin.csv").exit_code, 0);
    const json fit = json::parse(run("fit --profile skin.csv --model dipole --eta 1.3 --json").out);
    EXPECT_EQ(fit.at("format"), "searchlight-fit/1");
    EXPECT_EQ(fit.at("parameters").at(0).at("name"), "sigma_a");
    const double sigma_a[] = {0.032, 0.17, 0.48};
    for (std::size_t c = 0; c < 3; ++c)
        EXPECT_NEAR(fit.at("parameters").at(0).at("value").at(c).get<double>() / sigma_a[c], 1, 1e-6);

    ASSERT_EQ(run("reference halfspace --material skin1 --walks 2e4 -o reference.json").exit_code, 0);
    const Output burley = run("fit --profile reference.json --model burley --weight flux -o fit.svg --json");
    EXPECT_EQ(burley.exit_code, 0) << burley.err;
    // At 1e6 walks A is 0.4397 +- 0.0034; at 2e4 the noise adds less than that.
    EXPECT_NEAR(json::parse(burley.out).at("parameters").at(0).at("value").at(0).get<double>(), 0.4397, 0.014);
    EXPECT_THAT(readFile(folder() / "fit.svg"), testing::HasSubstr("Per unit flux that has entered"));
    EXPECT_EQ(run("fit --profile reference.json --model dipole --order multiple").exit_code, 0);
    EXPECT_EQ(
        run("fit --profile reference.json --model dipole --free sigma_a").err,
        "searchlight: dipole reads the medium, so sigma_sp has to be free (such as --free sigma_a,sigma_sp, and a "
        "parameter of the model if wanted)\n");
}

TEST_F(Program, RefusesDocumentsThatAreNoProfile) {
    const auto message = [&](const std::string& text) {
        writeFile(folder() / "x.json", text);
        return run("fit --profile x.json").err;
    };
    const std::string head = R"({"format":"searchlight-profile/1","per":"transmitted","material":{"eta":1.3},)";
    EXPECT_EQ(
        message("{}"),
        "searchlight: x.json: no profile (expected the document that `reference halfspace` or `profile` writes)\n");
    EXPECT_EQ(message(R"({"format":"searchlight-fit/1"})"),
              "searchlight: x.json: 'searchlight-fit/1' is no profile (expected searchlight-reference/1 or "
              "searchlight-profile/1)\n");
    EXPECT_EQ(message(head + R"("radii_mm":[1,1],"Rd":[[1,1]]})"),
              "searchlight: x.json: the radii do not ascend (radii are at least 0 and grow)\n");
    EXPECT_EQ(message(head + R"("radii_mm":[1,2],"Rd":[[1,1],[1,1]]})"),
              "searchlight: x.json: the profile has 2 channels (expected 1 or 3)\n");
    EXPECT_EQ(message(head + R"("radii_mm":[1,2],"Rd":[[1]]})"),
              "searchlight: x.json: the profile's lists differ in length\n");
    EXPECT_EQ(message(head + R"("radii_mm":[1,2],"Rd":[[null]]})"),
              "searchlight: x.json: channel 0 does not scatter (a fit needs values in every channel)\n");
    EXPECT_EQ(message(head + R"("angle_deg":30,"radii_mm":[1,2],"Rd":[[1,2]]})"),
              "searchlight: x.json: the beam was oblique (a fit needs a profile at normal incidence)\n");
}

TEST_F(Program, TheFitsOwnLineGivesItsCurve) {
    ASSERT_EQ(run("profile --model gaussians --radii 0.02,0.05,0.1,0.2,0.3,0.5,0.8,1.2,2,3,4,5 -o skin.csv").exit_code,
              0);
    const json fit = json::parse(run("fit --profile skin.csv --count 3 --json").out);
    const json curve =
        json::parse(run("profile " + fit.at("settings").get<std::string>() + " --radii 0.1,1.2 --json").out);
    for (const auto& [radius, at] : {std::pair<std::size_t, std::size_t>{2, 0}, {7, 1}})
        EXPECT_NEAR(
            curve.at("Rd").at(0).at(at).get<double>() / fit.at("residuals").at(0).at("fit").at(radius).get<double>(), 1,
            1e-12);
}

}  // namespace
}  // namespace searchlight
