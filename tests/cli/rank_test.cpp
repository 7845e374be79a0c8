#include <nlohmann/json.hpp>

#include "program.h"

namespace searchlight {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

class Rank : public Program {};

constexpr const char* problem = "rank --models dipole,better_dipole --sigma-a 0.1 --sigma-s 1,2,0 --noise 5";

TEST_F(Rank, JsonHasAllThatADocumentNeeds) {
    const json document = json::parse(run(std::string(problem) + " --json").out);
    EXPECT_EQ(document.at("format"), "searchlight-rank/1");
    EXPECT_EQ(document.at("material").at("id"), "custom");
    ASSERT_EQ(document.at("models").size(), 2u);
    double last = 0;
    for (const json& model : document.at("models")) {
        EXPECT_TRUE(model.at("id") == "dipole" || model.at("id") == "better_dipole");
        for (const char* kind : {"profile", "near", "far", "total", "shift", "oblique", "shape", "stderr"})
            EXPECT_TRUE(model.at("error").at(kind).is_number()) << kind;
        EXPECT_GE(model.at("error").at("profile"), last) << "in order of the error";
        last = model.at("error").at("profile");
        EXPECT_EQ(model.at("error").at("shift"), 1) << "neither reads the direction";
        EXPECT_GT(model.at("cost_ns"), 0);
        EXPECT_FALSE(model.at("fails").get<std::string>().empty());
        ASSERT_EQ(model.at("channels").size(), 2u) << "blue does not scatter";
        EXPECT_EQ(model.at("channels").at(1).at("channel"), "G");
    }
    EXPECT_GT(document.at("reference").at("stderr").at("profile"), 0);
    EXPECT_LT(document.at("reference").at("stderr").at("profile"), 0.07);
    EXPECT_EQ(document.at("reference").at("channels").at(1).at("split_mm"), 1 / 2.1);
}

TEST_F(Rank, IsTheSameOnAnyNumberOfThreads) {
    json one = json::parse(run(std::string(problem) + " --json --threads 1").out),
         two = json::parse(run(std::string(problem) + " --json --threads 2").out);
    for (json* document : {&one, &two}) {
        document->erase("job");
        for (json& model : document->at("models")) model.erase("cost_ns");
    }
    EXPECT_EQ(one, two);
}

TEST_F(Rank, WritesAPageWithFigures) {
    const Output output = run(std::string(problem) + " -o rank.html");
    EXPECT_EQ(output.exit_code, 0) << output.err;
    const std::string page = readFile(folder() / "rank.html");
    for (const char* part : {"Classical dipole", "<svg", "Errors on", "Searchlight profile", "where it fails"})
        EXPECT_THAT(page, HasSubstr(part));
}

TEST_F(Rank, SaysWhichModelsAreNotAboutAHalfSpaceOfTheMedium) {
    const Output output = run("rank --sigma-a 0.1 --sigma-s 1 --noise 5 --json");
    EXPECT_THAT(output.err, HasSubstr("gaussians is left out: it does not read the medium"));
    for (const json& model : json::parse(output.out).at("models")) EXPECT_NE(model.at("id"), "gaussians");
}

TEST_F(Rank, RanksAModelOfOnesOwnBesideTheShippedOnes) {
    writeFile(folder() / "flat.csv", "r_mm, R_d\n0, 0.1\n1, 0.1\n2, 0\n");
    const Output output = run("rank --models dipole,./flat.csv --sigma-a 0.1 --sigma-s 1 --noise 5");
    EXPECT_EQ(output.exit_code, 0) << output.err;
    EXPECT_THAT(output.out, HasSubstr("./flat.csv: "));
}

}  // namespace
}  // namespace searchlight
