#include <nlohmann/json.hpp>

#include "program.h"

namespace searchlight {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

class Kernel : public Program {
protected:
    json document(const std::string& arguments) const {
        const Output output = run("kernel --model better_dipole " + arguments + " --json");
        EXPECT_EQ(output.exit_code, 0) << output.err;
        return json::parse(output.out);
    }
};

TEST_F(Kernel, TapsComeOutAsATableThatReadsBackWithoutFault) {
    const Output output = run(
        "kernel --model better_dipole --material skin1 --method preintegrated --taps 17 --export hlsl -o kernel.hlsl");
    EXPECT_EQ(output.exit_code, 0) << output.err;
    EXPECT_THAT(output.out, HasSubstr("static const float4 kernel[17]"));
    EXPECT_THAT(output.out, HasSubstr("mm"));
    const Output check = run("kernel --model better_dipole --material skin1 --check kernel.hlsl");
    EXPECT_EQ(check.exit_code, 0) << check.out;
    EXPECT_THAT(check.out, HasSubstr("no faults"));
}

TEST_F(Kernel, JsonHasErrorsTapsAndNorm) {
    for (const char* arguments :
         {"--material skin1 --method svd --rank 3", "--material ketchup --method guided --k 1",
          "--material marble --method gaussians --count 4", "--material skin1 --method optimised --rank 2"}) {
        const json kernel = document(arguments);
        EXPECT_EQ(kernel.at("format"), "searchlight-kernel/1");
        for (const char* key : {"kernel_rms", "kernel_rms_raw"}) EXPECT_EQ(kernel.at("error").at(key).size(), 3u);
        EXPECT_LT(kernel.at("error").at("image_rms").at("overall").get<double>(), 0.1);
        EXPECT_EQ(kernel.at("error").at("image_rms").at("edge").size(), 3u);
        EXPECT_EQ(kernel.at("taps").size(), kernel.at("rank").get<std::size_t>());
        for (const json& norm : kernel.at("norm1")) EXPECT_NEAR(norm.get<double>(), 1, 1e-6) << arguments;
        EXPECT_LT(kernel.at("truth").at("energy_beyond").at(0).get<double>(), 2e-4);
    }
}

TEST_F(Kernel, AllMethodsMakeAPage) {
    const Output output = run("kernel --model better_dipole --material skin1 --all --size 64 -o kernels.html");
    EXPECT_EQ(output.exit_code, 0) << output.err;
    const std::string page = readFile(folder() / "kernels.html");
    for (const char* part : {"<svg", "optimised 2", "preintegrated", "FLIP", "along the axis"})
        EXPECT_THAT(page, HasSubstr(part));
}

TEST_F(Kernel, ErrorsInKernelSpaceAreThoseOfThePublishedTable) {
    // [Freude2014] Table 6.3, red: pre-integration and guided optimisation over SVD of rank 1, within 20 %. Few walks:
    // their noise moves the ratios by a few percent.
    const Output output = run("paper freude2014 --table 6.3 --reference-walks 200000 --json", "XDG_CACHE_HOME=cache");
    ASSERT_EQ(output.exit_code, 0) << output.err;
    const json values = json::parse(output.out).at("figures").at(0).at("values");
    const auto ratio = [&](const char* material, const char* method) {
        const json& row = values.at(material);
        return row.at(method).at(0).get<double>() / row.at("svd_1").at(0).get<double>();
    };
    const auto expect = [&](const char* material, double preintegrated, double guided) {
        EXPECT_NEAR(ratio(material, "preintegrated") / preintegrated, 1, 0.2) << material;
        EXPECT_NEAR(ratio(material, "guided") / guided, 1, 0.2) << material;
    };
    expect("apple", 0.120 / 0.057, 0.137 / 0.057);
    expect("marble", 0.079 / 0.038, 0.090 / 0.038);
    expect("ketchup", 0.139 / 0.061, 0.141 / 0.061);
    expect("skin1", 0.074 / 0.035, 0.084 / 0.035);
    expect("whole_milk", 0.074 / 0.036, 0.084 / 0.036);
}

TEST_F(Kernel, FaultsOfATableAreAnExitCode) {
    writeFile(
        folder() / "copy.glsl",
        "const vec4 skin[3] = vec4[](vec4(0.5, 0.5, 0.5, 0), vec4(0.25, 0.26, 0.25, -1), vec4(0.25, 0.25, 0.25, 1));");
    const Output output = run("kernel --model better_dipole --material skin1 --check copy.glsl");
    EXPECT_EQ(output.exit_code, 1) << output.err;
    EXPECT_THAT(output.out, HasSubstr("green adds up to 1.01"));
    EXPECT_THAT(output.out, HasSubstr("with its width times"));
}

TEST_F(Kernel, GrayMediaAndChannelsThatDoNotScatterHaveKernels) {
    const json kernel = document("--sigma-a 0.1 --sigma-s 1,2,0 --method optimised");
    for (const json& norm : kernel.at("norm1")) EXPECT_NEAR(norm.get<double>(), 1, 1e-6);
    document("--sigma-a 0.1 --sigma-s 1 --method svd --rank 2");
}

}  // namespace
}  // namespace searchlight
