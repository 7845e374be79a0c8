#include <gtest/gtest.h>

#include "base/files.h"
#include "job/live/live_plot.h"

namespace searchlight {
namespace {

TEST(LivePlotGl, ABrokenModelLeavesTheOthersAndComesBackWhenItsFileIsMended) {
    const std::string path = testing::TempDir() + "live_plot.bssrdf";
    const std::string good =
        "analytic radial no_wi no_wo\n::begin shader\n"
        "vec3 Bssrdf(vec3 Xi, vec3 Wi, vec3 Xo, vec3 Wo) { return exp(-SigmaA * length(Xo - Xi)); }\n::end shader\n";
    std::string bad = good;
    bad.insert(bad.find("return"), "oops ");
    writeFile(path, bad);
    Engine engine;
    LivePlot plot(engine);
    LiveRequest request;
    request.models = {{.model = {.id = path}, .color = 4}, {.model = {.id = "dipole"}, .color = 5}};
    request.walks = 0;
    const LivePlotResult broken = plot.draw(request, LiveDetail::fine);
    ASSERT_EQ(broken.problems.size(), 1u);
    EXPECT_EQ(broken.problems[0].model, 0u);
    EXPECT_EQ(broken.problems[0].error.line, 3);
    EXPECT_EQ(broken.figure.series.size(), 1u);
    EXPECT_EQ(broken.figure.series[0].color, 5) << "the colour of its slot";
    writeFile(path, good);
    const LivePlotResult mended = plot.draw(request, LiveDetail::fine);
    EXPECT_TRUE(mended.problems.empty());
    EXPECT_EQ(mended.figure.series.size(), 2u);
}

}  // namespace
}  // namespace searchlight
