// Are the standard errors honest? The same problem under many seeds must scatter as much as one result says it does.
#include "exact.h"

namespace searchlight {
namespace {

// 1,000 repetitions know a spread within 2.2 %; 0.1 is 4.5 times that.
TEST(HalfSpace, StandardErrorsAreTheSpreadOverSeeds) {
    constexpr int seeds = 1000;
    constexpr double walks = 8192;
    const HalfSpaceProblem problem{.sigma_a = 0.1, .sigma_s = 0.9, .eta = 1.3, .angle_deg = 45};
    const std::vector<double> edges = {0, 0.2, 0.5, 1, 2, 4};
    struct Spread {
        double sum = 0, square = 0, variance = 0;
        void add(double value, double error) { sum += value, square += value * value, variance += error * error; }
        double ratio() const { return std::sqrt((square - sum * sum / seeds) / (seeds - 1) / (variance / seeds)); }
    };
    Spread total, single, x, r2, bins[5], cells[16];
    for (int seed = 0; seed < seeds; ++seed) {
        Observer observer;
        HalfSpaceOptions o;
        o.walks = static_cast<std::uint64_t>(walks);
        o.seed = static_cast<std::uint64_t>(seed);
        o.edges_mm = edges;
        o.grid = 4;
        o.grid_extent_mm = 1;
        const HalfSpaceTally all = walkHalfSpace(problem, o, observer).all;
        total.add(all.total.mean, all.total.standard_error);
        x.add(all.mean_x_mm.mean, all.mean_x_mm.standard_error);
        r2.add(all.mean_r2_mm2.mean, all.mean_r2_mm2.standard_error);
        for (std::size_t i = 0; i < 5; ++i) bins[i].add(all.Rd[i], all.standard_error[i]);
        for (std::size_t i = 0; i < 16; ++i) cells[i].add(all.grid[i], all.grid_standard_error[i]);
    }
    EXPECT_NEAR(total.ratio(), 1, 0.1);
    EXPECT_NEAR(x.ratio(), 1, 0.1);
    EXPECT_NEAR(r2.ratio(), 1, 0.1);
    for (const Spread& bin : bins) EXPECT_NEAR(bin.ratio(), 1, 0.1);
    for (const Spread& cell : cells) EXPECT_NEAR(cell.ratio(), 1, 0.1);
}

}  // namespace
}  // namespace searchlight
