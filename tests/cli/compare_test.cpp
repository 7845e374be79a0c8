#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "program.h"

namespace searchlight {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::StartsWith;

// A grey PFM, on machines that store the lowest byte first.
std::string pfm(int width, int height, const std::vector<float>& values) {
    std::string bytes = "Pf\n" + std::to_string(width) + " " + std::to_string(height) + "\n-1\n";
    return bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float));
}

TEST_F(Program, CompareStatesEveryMetric) {
    writeFile(folder() / "image.pfm", pfm(16, 16, std::vector<float>(256, 0.6f)));
    writeFile(folder() / "reference.pfm", pfm(16, 16, std::vector<float>(256, 0.5f)));
    const Output output = run("compare image.pfm reference.pfm --json -o difference.png");
    ASSERT_EQ(output.exit_code, 0) << output.err;
    const json compared = json::parse(output.out);
    EXPECT_EQ(compared.at("format"), "searchlight-compare/1");
    EXPECT_NEAR(compared.at("rmse").get<double>(), 0.1, 1e-6);
    EXPECT_NEAR(compared.at("relative_rmse").get<double>(), 0.2, 1e-6);
    EXPECT_NEAR(compared.at("mean_difference").get<double>(), 0.2, 1e-6);
    EXPECT_NEAR(compared.at("largest").get<double>(), 0.1, 1e-6);
    EXPECT_EQ(compared.at("pixels"), 256);
    EXPECT_GT(compared.at("ssim").get<double>(), 0.99);
    EXPECT_GT(compared.at("flip").get<double>(), 0.01);
    EXPECT_THAT(readFile(folder() / "difference.png"), StartsWith("\x89PNG"));
    // The same by name, and the other way round.
    const Output back = run("compare --reference image.pfm --image reference.pfm --json");
    EXPECT_NEAR(json::parse(back.out).at("mean_difference").get<double>(), -1.0 / 6, 1e-6);
}

TEST_F(Program, CompareRefusesOtherSizesAndFiles) {
    writeFile(folder() / "small.pfm", pfm(1, 1, {1}));
    writeFile(folder() / "large.pfm", pfm(2, 1, {1, 1}));
    const Output sizes = run("compare small.pfm large.pfm -o difference.png");
    EXPECT_EQ(sizes.exit_code, 2);
    EXPECT_THAT(sizes.err, HasSubstr("small.pfm is 1 x 1 pixels, large.pfm is 2 x 1"));
    const Output missing = run("compare small.pfm nowhere.pfm");
    EXPECT_EQ(missing.exit_code, 3);
    EXPECT_THAT(missing.err, HasSubstr("nowhere.pfm: no such file"));
    const Output alone = run("compare small.pfm");
    EXPECT_EQ(alone.exit_code, 2);
    EXPECT_THAT(alone.err, HasSubstr("--reference is missing"));
    EXPECT_EQ(fileCount(), 2u) << "no difference was written";
}

}  // namespace
}  // namespace searchlight
