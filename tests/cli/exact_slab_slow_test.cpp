#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <utility>

#include "program.h"

namespace searchlight {
namespace {

using nlohmann::json;

// Ten seconds of CPU.
TEST_F(Program, ExactSlabHasTotalsAndProfilesWithTheirErrors) {
    writeFile(folder() / "layers.json", R"({"format": "searchlight-layers/1", "layers": [
        {"n": 1, "sigma_a": 0.1, "sigma_s": 0.9, "g": 0.5, "thickness_mm": 1}]})");
    const json slab =
        json::parse(run("reference slab --layers layers.json --exact --radii-max 5 --bins 20 --json").out);
    EXPECT_EQ(slab.at("format"), "searchlight-slab/1");
    EXPECT_EQ(slab.at("estimator"), "exact");
    // tests/data/transport/slabs.csv, nine digits.
    EXPECT_NEAR(slab.at("R").at("mean").get<double>(), 0.129793280, 1e-8);
    EXPECT_NEAR(slab.at("T").at("mean").get<double>(), 0.371211679, 1e-8);
    EXPECT_NEAR(slab.at("layers").at(0).at("absorbed").at("mean").get<double>(), 0.131115600, 1e-8);
    EXPECT_LT(slab.at("R").at("stderr").get<double>(), 1e-7);
    for (const char* series : {"R_r", "T_r"}) {
        ASSERT_EQ(slab.at(series).at("mean").size(), 20u);
        for (std::size_t i = 0; i < 20; ++i) {
            const double mean = slab.at(series).at("mean").at(i), error = slab.at(series).at("stderr").at(i);
            EXPECT_GT(mean, 0);
            EXPECT_GT(error, 0);
            EXPECT_LT(error, 0.02 * mean) << series << " " << i;
        }
    }
    // Per solid angle outside, in thirty parts of 90 degrees.
    for (const auto& [series, total] : {std::pair{"R_a", "R"}, std::pair{"T_a", "T"}}) {
        double sum = 0;
        for (std::size_t i = 0; i < 30; ++i) {
            const auto cosine = [](std::size_t edge) {
                return std::cos(static_cast<double>(edge) / 60 * std::numbers::pi);
            };
            sum += slab.at(series).at("mean").at(i).get<double>() * 2 * std::numbers::pi * (cosine(i) - cosine(i + 1));
        }
        EXPECT_NEAR(sum, slab.at(total).at("mean").get<double>(), 1e-4) << series;
    }
    for (const char* walked : {"walks", "A_z", "R_single", "maps"}) EXPECT_FALSE(slab.contains(walked)) << walked;
}

}  // namespace
}  // namespace searchlight
