#include "job/sweep/sweep.h"

#include <set>

#include "base/error.h"
#include "illegal/messages.h"
#include "job/render/turntable.h"

namespace searchlight {
namespace {

constexpr std::string_view quick = R"({
 "format": "searchlight-sweep/1",
 "title": "Two by two by three",
 "base": {"object": "sphere", "scale": 20, "model": "better_dipole"},
 "render": {"size": "32x24", "points": "500"},
 "axes": [
  {"key": "material", "values": ["marble", {"sigma_a": 0.1, "sigma_s": 2}], "labels": ["marble", "grey"]},
  {"key": "/camera/azimuth_deg", "from": 0, "to": 360, "steps": 3},
  {"key": "/model/parameters/Moments", "values": ["published", "exact"]}],
 "sheet": {"columns": "/camera/azimuth_deg", "exposure": "row"}
})";

TEST(Sweep, CellsAreAllCombinationsTheLastAxisChangingFastest) {
    const Sweep sweep = parseSweep(quick, "quick.json");
    ASSERT_EQ(sweep.cells.size(), 12u);
    std::set<std::string> jobs;
    for (std::size_t i = 0; i < sweep.cells.size(); ++i) {
        EXPECT_EQ(sweep.cells[i].number, i + 1);
        jobs.insert(jobJson(sweep.cells[i].job));
    }
    EXPECT_EQ(jobs.size(), 12u);
    EXPECT_EQ(cellName(sweep, sweep.cells[0]), "marble, 0, published");
    EXPECT_EQ(cellName(sweep, sweep.cells[1]), "marble, 0, exact");
    EXPECT_EQ(cellName(sweep, sweep.cells[11]), "grey, 240, exact");
    const Job& job = sweep.cells[11].job;
    EXPECT_EQ(job.command, "render");
    EXPECT_EQ(job.scene.material.sigma_s, std::vector<double>{2});
    EXPECT_EQ(job.scene.camera.azimuth_deg, 240);
    EXPECT_EQ(job.scene.scale, 20);
    EXPECT_EQ(job.scene.model.id, "better_dipole");
    EXPECT_EQ(std::get<std::string>(job.scene.model.parameters.at("Moments")), "exact");
    EXPECT_EQ(std::get<std::string>(job.options.at("size")), "32x24");
}

TEST(Sweep, AxesHaveTitlesWithUnitsAndLabels) {
    const Sweep sweep = parseSweep(quick, "quick.json");
    EXPECT_EQ(sweep.axes[0].title, "Material");
    EXPECT_EQ(sweep.axes[1].title, "Azimuth (deg)");
    EXPECT_EQ(sweep.axes[1].labels, (std::vector<std::string>{"0", "120", "240"}));
    EXPECT_EQ(sweep.axes[2].title, "Moments");
    // What the sheet does not mention goes on in the rows.
    EXPECT_EQ(sweep.sheet.columns, std::vector<std::size_t>{1});
    EXPECT_EQ(sweep.sheet.rows, (std::vector<std::size_t>{0, 2}));
    EXPECT_EQ(sweep.sheet.shared, SharedExposure::row);
}

TEST(Sweep, CountIncludesTheEndAndStepsDoNot) {
    const auto labels = [](const std::string& range) {
        return parseSweep(R"({"format": "searchlight-sweep/1", "axes": [{"key": "scale", "from": 10, "to": 20, )" +
                              range + "}]}",
                          "range.json")
            .axes[0]
            .labels;
    };
    EXPECT_EQ(labels("\"count\": 3"), (std::vector<std::string>{"10", "15", "20"}));
    EXPECT_EQ(labels("\"steps\": 2"), (std::vector<std::string>{"10", "15"}));
}

TEST(Sweep, SeveralKeysMayChangeTogether) {
    const Sweep sweep = parseSweep(R"({"format": "searchlight-sweep/1", "base": {"ground": {"height": 0.1}}, "axes": [
        {"key": "scene", "values": [{"object": "statue", "scale": 50}, {"object": "slab", "ground": null}]},
        {"key": "render", "values": [{"technique": "hierarchical", "error": 0.01}, {"technique": "brute_force"}]},
        {"key": "/material/scale", "values": [2]},
        {"key": "/coat/roughness", "values": [0.5]},
        {"key": "seed", "values": [7]}]})",
                                   "together.json");
    ASSERT_EQ(sweep.cells.size(), 4u);
    EXPECT_EQ(cellName(sweep, sweep.cells[0]), "statue, hierarchical, 2, 0.5, 7");
    EXPECT_EQ(sweep.cells[0].job.scene.scale, 50);
    EXPECT_EQ(sweep.cells[0].job.scene.ground->height, 0.1);
    EXPECT_EQ(std::get<double>(sweep.cells[0].job.options.at("error")), 0.01);
    EXPECT_FALSE(sweep.cells[3].job.scene.ground);
    EXPECT_EQ(sweep.cells[3].job.options.count("error"), 0u);
    // A material that was named keeps its name.
    EXPECT_EQ(sweep.cells[3].job.scene.material.id, "skin1");
    EXPECT_EQ(sweep.cells[3].job.scene.material.scale, 2);
    EXPECT_EQ(sweep.cells[3].job.scene.coat->roughness, 0.5);
    EXPECT_EQ(sweep.cells[3].job.seed, 7u);
}

TEST(Sweep, EarlyStagesChangeLeastOftenAndShardsShareTheCells) {
    const Sweep sweep = parseSweep(quick, "quick.json");
    std::vector<std::size_t> order;
    for (const SweepCell* cell : cellsInOrder(sweep, 0, 1)) order.push_back(cell->number);
    // Material before model before camera.
    EXPECT_EQ(order, (std::vector<std::size_t>{1, 3, 5, 2, 4, 6, 7, 9, 11, 8, 10, 12}));
    std::multiset<std::size_t> shared;
    for (std::size_t shard = 0; shard < 5; ++shard)
        for (const SweepCell* cell : cellsInOrder(sweep, shard, 5)) shared.insert(cell->number);
    EXPECT_EQ(shared.size(), 12u);
    EXPECT_EQ(std::set<std::size_t>(shared.begin(), shared.end()).size(), 12u);
}

TEST(Sweep, EveryIllegalFileFailsWithItsMessage) {
    expectMessages("sweeps", [](auto text, auto path) { parseSweep(text, path); });
}

TEST(Turntable, NumbersStandWhereTheSharpsStood) {
    EXPECT_EQ(framePath("a/frame_####.png", 7), "a/frame_0007.png");
    EXPECT_EQ(framePath("#.exr", 48), "48.exr");
    for (const char* wrong : {"frame.png", "#_#.png", ""}) {
        try {
            framePath(wrong, 1);
            ADD_FAILURE() << wrong;
        } catch (const Error& error) {
            EXPECT_EQ(error.kind, ErrorKind::usage) << wrong;
            EXPECT_EQ(error.hint, "such as frame_####.png");
        }
    }
}

}  // namespace
}  // namespace searchlight
