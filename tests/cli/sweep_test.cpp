#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/csv.h"
#include "io/image_file.h"
#include "program.h"

namespace searchlight {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

// Four cells, of which two share everything but the camera.
json quickSweep() {
    return json::parse(R"({
 "format": "searchlight-sweep/1", "title": "Quick",
 "base": {"object": "sphere", "scale": 20},
 "render": {"size": "32x32", "points": "500", "cache": "none"},
 "axes": [{"key": "material", "values": ["marble", "skin1"]},
          {"key": "/camera/azimuth_deg", "from": 0, "to": 360, "steps": 2}]
})");
}

bool sameCells(const fs::path& a, const fs::path& b, int count) {
    for (int i = 1; i <= count; ++i) {
        const std::string name = "cell_000" + std::to_string(i) + ".exr";
        if (readImage((a / name).string()).image.pixels != readImage((b / name).string()).image.pixels) return false;
    }
    return true;
}

TEST_F(Program, ASweepLeavesItsCellsASheetAndASummary) {
    writeFile(folder() / "quick.json", quickSweep().dump());
    const Output output = run("sweep quick.json --json");
    ASSERT_EQ(output.exit_code, 0) << output.err;
    const json document = json::parse(output.out);
    EXPECT_EQ(document.at("rendered"), 4);
    EXPECT_EQ(document.at("files").size(), 3u);
    // The folder is called as the file is: 4 pictures, their numbers, sheet, two summaries; and the sweep itself.
    EXPECT_EQ(fileCount(), 4u + 4 + 3 + 1);

    const json summary = json::parse(readFile(folder() / "quick/summary.json"));
    EXPECT_EQ(summary.at("format"), "searchlight-sweep-summary/1");
    ASSERT_EQ(summary.at("cells").size(), 4u);
    const json& cell = summary.at("cells").at(3);
    EXPECT_EQ(cell.at("values").at("material"), "skin1");
    EXPECT_EQ(cell.at("values").at("/camera/azimuth_deg"), "180");
    const ImageFile file = readImage((folder() / "quick" / cell.at("file")).string());
    double green = 0, covered = 0;
    for (const Rgba& pixel : file.image.pixels) green += pixel.g, covered += pixel.a;
    EXPECT_DOUBLE_EQ(cell.at("mean_radiance").at(1), green / covered);
    EXPECT_DOUBLE_EQ(cell.at("coverage"), covered / (32 * 32));

    const CsvTable table = parseCsv(readFile(folder() / "quick/summary.csv"), "summary.csv");
    ASSERT_EQ(table.rows.size(), 4u);
    EXPECT_DOUBLE_EQ(table.number(3, table.find("mean_G").value()), green / covered);
    EXPECT_EQ(table.rows[3][table.find("material").value()].text, "skin1");
}

TEST_F(Program, ACellIsTheRenderJobThatItPrints) {
    writeFile(folder() / "quick.json", quickSweep().dump());
    ASSERT_EQ(run("sweep quick.json -o cells").exit_code, 0);
    writeFile(folder() / "job.json", run("sweep quick.json --cell 3").out);
    // Alone, by a renderer that kept nothing.
    ASSERT_EQ(run("run job.json -o alone.exr").exit_code, 0);
    EXPECT_EQ(readImage((folder() / "alone.exr").string()).image.pixels,
              readImage((folder() / "cells/cell_0003.exr").string()).image.pixels);
}

TEST_F(Program, ShardsMakeWhatOneRunMakes) {
    writeFile(folder() / "quick.json", quickSweep().dump());
    ASSERT_EQ(run("sweep quick.json -o whole").exit_code, 0);
    ASSERT_EQ(run("sweep quick.json -o parts --shard 1/3").exit_code, 0);
    EXPECT_FALSE(fs::exists(folder() / "parts/summary.json"));
    const Output early = run("sweep quick.json -o parts --merge");
    EXPECT_EQ(early.exit_code, 3);
    EXPECT_EQ(early.err, "searchlight: 2 of 4 cells are missing in parts: 2, 3 (without --merge they are rendered)\n");
    ASSERT_EQ(run("sweep quick.json -o parts --shard 2/3").exit_code, 0);
    ASSERT_EQ(run("sweep quick.json -o parts --shard 3/3").exit_code, 0);
    EXPECT_TRUE(sameCells(folder() / "whole", folder() / "parts", 4));
    // The last of them found all cells and drew the sheet.
    for (const fs::directory_entry& entry : fs::directory_iterator(folder() / "whole"))
        if (entry.path().stem() == "sheet") {
            EXPECT_EQ(readFile(entry.path()), readFile(folder() / "parts" / entry.path().filename()));
        }
    fs::remove(folder() / "parts/summary.csv");
    ASSERT_EQ(run("sweep quick.json -o parts --merge").exit_code, 0);
    EXPECT_TRUE(fs::exists(folder() / "parts/summary.csv"));
}

TEST_F(Program, ASweepGoesOnWhereItStopped) {
    json sweep = quickSweep();
    writeFile(folder() / "quick.json", sweep.dump());
    ASSERT_EQ(run("sweep quick.json -o cells").exit_code, 0);
    const auto rendered = [&] {
        const Output output = run("sweep quick.json -o cells --json");
        EXPECT_EQ(output.exit_code, 0) << output.err;
        return json::parse(output.out).at("rendered").get<int>();
    };
    EXPECT_EQ(rendered(), 0);
    fs::remove(folder() / "cells/cell_0002.exr");
    EXPECT_EQ(rendered(), 1);
    writeFile(folder() / "cells/cell_0003.json", "{");
    EXPECT_EQ(rendered(), 1);
    // Cells of another job are no cells of this one.
    sweep["axes"][0]["values"][1] = "potato";
    writeFile(folder() / "quick.json", sweep.dump());
    EXPECT_EQ(rendered(), 2);
}

TEST_F(Program, AnErrorInACellNamesIt) {
    json sweep = quickSweep();
    sweep["axes"][0]["values"][1] = "marbel";
    writeFile(folder() / "quick.json", sweep.dump());
    const Output output = run("sweep quick.json");
    EXPECT_EQ(output.exit_code, 2);
    EXPECT_EQ(output.err,
              "searchlight: cell 3 (marbel, 0): unknown material 'marbel' (did you mean: marble, merlot, apple)\n");
    // What was finished before stays.
    EXPECT_TRUE(fs::exists(folder() / "quick/cell_0002.exr"));
}

TEST_F(Program, ShardsAreCountedFromOne) {
    writeFile(folder() / "quick.json", quickSweep().dump());
    for (const char* wrong : {"0/2", "3/2", "1", "1/2/3", "a/b", "1.5/2"}) {
        const Output output = run(std::string("sweep quick.json --shard ") + wrong);
        EXPECT_EQ(output.exit_code, 2) << wrong;
        EXPECT_EQ(output.err, std::string("searchlight: '") + wrong +
                                  "' is no value for shard (expected i/n with i from 1 to n)\n");
    }
}

TEST_F(Program, ProcessesOfMpirunShareTheCells) {
    if (std::string(SEARCHLIGHT_MPIRUN).empty()) GTEST_SKIP() << "built without MPI";
    writeFile(folder() / "quick.json", quickSweep().dump());
    ASSERT_EQ(run("sweep quick.json -o whole").exit_code, 0);
    const Output output =
        run("sweep quick.json -o parts --json", SEARCHLIGHT_MPIRUN " --allow-run-as-root --oversubscribe -n 3");
    ASSERT_EQ(output.exit_code, 0) << output.err;
    EXPECT_EQ(json::parse(output.out).at("rendered"), 4);
    EXPECT_TRUE(sameCells(folder() / "whole", folder() / "parts", 4));
}

TEST_F(Program, ATurntableGoesOnceAround) {
    const Output output =
        run("render torus_knot --scale 20 --size 32x32 --points 500 --cache none --camera 170,10 --turntable 4 "
            "-o frame_###.exr --json");
    ASSERT_EQ(output.exit_code, 0) << output.err;
    const json frames = json::parse(output.out).at("frames");
    ASSERT_EQ(frames.size(), 4u);
    EXPECT_EQ(frames.at(0).at("file"), "frame_001.exr");
    EXPECT_EQ(fileCount(), 4u);
    const double azimuths[] = {170, -100, -10, 80};
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(frames.at(i).at("camera").at("azimuth_deg"), azimuths[i]);
        EXPECT_EQ(frames.at(i).at("camera").at("distance"), frames.at(0).at("camera").at("distance"));
    }
    // Light and points stay.
    EXPECT_EQ(frames.at(3).at("ms").at("irradiance"), 0);
    EXPECT_EQ(run("render --turntable 4 -o frame.png").err,
              "searchlight: 'frame.png' has no place for a frame's number (such as frame_####.png)\n");
}

}  // namespace
}  // namespace searchlight
