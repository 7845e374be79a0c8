// Oblique light and papers, from the command line to the files.
#include <nlohmann/json.hpp>

#include "program.h"

namespace searchlight {
namespace {

using Json = nlohmann::json;

class Oblique : public Program {};

constexpr const char* medium = " --sigma-a 0.1 --sigma-s 1 --g 0 --eta 1 --models dipole,directional_dipole";

TEST_F(Oblique, PlotsShowModelsBesideTheReference) {
    for (const char* plot :
         {"oblique --angle-deg 0,60 --reference-walks 1e4", "slice --angle-deg 60 --cells 16 --reference-walks 1e4",
          "moments --angle-deg 0,60 --reference-walks 1e4", "hemisphere --angle-deg 60 --reference-walks 1e4"}) {
        const Output output = run(std::string("plot ") + plot + medium + " -o figure.svg --json");
        ASSERT_EQ(output.exit_code, 0) << plot << output.err;
        const Json json = Json::parse(output.out);
        EXPECT_EQ(json["format"], "searchlight-figure/1");
        EXPECT_GE(json["panels"].size(), 2u) << plot;
        const std::string svg = readFile(folder() / "figure.svg");
        for (const char* label : {"Classical dipole", "Directional dipole", "Monte Carlo"})
            EXPECT_NE(svg.find(label), std::string::npos) << plot << label;
        EXPECT_LT(svg.size(), 200'000u) << plot;
    }
}

TEST_F(Oblique, MomentsAreInTheDocumentWithTheirErrors) {
    const Output output =
        run(std::string("plot moments --angle-deg 0,60 --reference-walks 1e5 -o moments.csv --json") + medium);
    ASSERT_EQ(output.exit_code, 0) << output.err;
    const Json json = Json::parse(output.out);
    EXPECT_EQ(json["angles_deg"], Json({0, 60}));
    EXPECT_EQ(json["models"][0]["model"], "dipole");
    EXPECT_EQ(json["models"][0]["mean_x_mm"], Json({0, 0}));
    const double shift = json["reference"]["mean_x_mm"]["mean"][1], error = json["reference"]["mean_x_mm"]["stderr"][1];
    EXPECT_GT(shift, 10 * error);
    EXPECT_GT(json["models"][1]["mean_x_mm"][1].get<double>(), 0);
}

TEST_F(Oblique, SameSeedSamePlot) {
    const std::string plot = std::string("plot oblique --angle-deg 45 --reference-walks 1e4") + medium;
    const std::string first = run(plot + " --threads 1").out;
    // The job, which names the threads, is a comment of the table.
    const auto rows = [](const std::string& csv) { return csv.substr(csv.find("series,x,")); };
    EXPECT_EQ(rows(run(plot + " --threads 2").out), rows(first));
    EXPECT_NE(rows(run(plot + " --seed 2").out), rows(first));
}

TEST_F(Oblique, APaperLeavesFiguresDataAndFindings) {
    const Output output = run("paper frisvad2014 --figure 12,5 --reference-walks 2e4 -o out --json");
    ASSERT_EQ(output.exit_code, 0) << output.err;
    for (const char* stem : {"frisvad2014_fig12", "frisvad2014_fig5"})
        for (const char* ending : {".svg", ".csv", ".txt", ".json"})
            EXPECT_TRUE(std::filesystem::exists(folder() / "out" / (std::string(stem) + ending))) << stem << ending;
    EXPECT_EQ(fileCount(), 8u);
    const Json json = Json::parse(output.out);
    EXPECT_EQ(json["format"], "searchlight-paper/1");
    EXPECT_EQ(json["figures"][0]["figure"], "12");
    EXPECT_FALSE(json["figures"][0]["statements"].empty());
    const Json alone = Json::parse(readFile(folder() / "out" / "frisvad2014_fig5.json"));
    EXPECT_EQ(alone["statements"], json["figures"][1]["statements"]);
}

}  // namespace
}  // namespace searchlight
