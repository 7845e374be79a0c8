// References that stop and go on.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "base/text.h"
#include "program.h"

namespace searchlight {
namespace {

using nlohmann::json;
using testing::HasSubstr;

const std::string half_space =
    "reference halfspace --sigma-a 0.1 --sigma-s 0.9 --eta 1.3 --edges 0,1,3 --json --seed 5 ";

json numbers(const std::string& text) {
    const json document = json::parse(text);
    return {document["diffuse"], document["profile"], document["mean_r2_mm2"], document["walks"],
            document["collisions"]};
}

TEST_F(Program, AResumedReferenceHasTheNumbersOfOneThatNeverStopped) {
    const Output straight = run(half_space + "--walks 8388608");
    const Output first = run(half_space + "--walks 4194304 --resume walks.json");
    EXPECT_EQ(json::parse(first.out)["walks"], 4194304);
    const Output second = run(half_space + "--walks 8388608 --resume walks.json");
    ASSERT_EQ(second.exit_code, 0) << second.err;
    EXPECT_EQ(numbers(second.out), numbers(straight.out));
}

// Its problem holds lists of objects: the lights.
TEST_F(Program, AResumedSphereHasTheNumbersOfOneThatNeverStopped) {
    const std::string sphere =
        "reference sphere --material skin1 --radius 2 --light dir:1,1,1 --size 16x16 --json --walks 5e6 ";
    const json straight = json::parse(run(sphere).out);
    const json first = json::parse(run(sphere + "--until-error 5% --resume walks.json").out);
    EXPECT_LT(first["walks"][0], straight["walks"][0]);
    const Output second = run(sphere + "--resume walks.json");
    ASSERT_EQ(second.exit_code, 0) << second.err;
    const json resumed = json::parse(second.out);
    for (const char* key : {"incident", "left", "reflectance", "absorbed", "walks", "collisions", "surface_tests"})
        EXPECT_EQ(resumed[key], straight[key]) << key;
}

TEST_F(Program, CtrlCLeavesAValidFileThatGoesOn) {
    const Output stopped = interrupt(half_space + "--walks 1e13 --resume walks.json -o part.json");
    EXPECT_EQ(stopped.exit_code, 130) << stopped.err;
    const json part = json::parse(readFile(folder() / "part.json"));
    EXPECT_EQ(part["interrupted"], true);
    const double walks = part["walks"];
    EXPECT_GT(walks, 0);
    // All that was walked is kept, so that as many walks again add nothing.
    const Output again = run(half_space + "--walks " + numberText(walks) + " --resume walks.json");
    ASSERT_EQ(again.exit_code, 0) << again.err;
    EXPECT_EQ(numbers(again.out), numbers(part.dump()));
}

TEST_F(Program, WalksOfAnotherProblemAreNotResumed) {
    ASSERT_EQ(run(half_space + "--walks 1000 --resume walks.json").exit_code, 0);
    const std::string before = readFile(folder() / "walks.json");
    const Output other = run(half_space + "--walks 1000 --angle-deg 10 --resume walks.json");
    EXPECT_EQ(other.exit_code, 3);
    EXPECT_THAT(other.err, HasSubstr("/problem/angle_deg: these are walks of another problem: /angle_deg differs"));
    EXPECT_EQ(readFile(folder() / "walks.json"), before);
}

// What a problem names only where it is used differs as well, on either side.
TEST_F(Program, WalksOfAnotherEstimatorAreNotResumed) {
    writeFile(folder() / "layers.json",
              R"({"format": "searchlight-layers/1", "n_above": 1, "n_below": 1, "layers": [
                  {"n": 1.5, "sigma_a": 0.05, "sigma_s": 2, "g": 0, "thickness_mm": 1}]})");
    const std::string slab = "reference slab --layers layers.json --walks 1000 ";
    for (const auto& [first, second] : {std::pair("analogue", "best"), std::pair("best", "analogue")}) {
        const std::string file = std::string("--resume ") + first + ".json --estimator ";
        ASSERT_EQ(run(slab + file + first).exit_code, 0);
        const Output other = run(slab + file + second);
        EXPECT_EQ(other.exit_code, 3);
        EXPECT_THAT(other.err, HasSubstr("these are walks of another problem: /estimator differs"));
    }
}

TEST_F(Program, DamagedWalksAreRefusedAndKept) {
    ASSERT_EQ(run(half_space + "--walks 1000 --resume walks.json").exit_code, 0);
    const std::string good = readFile(folder() / "walks.json");
    const json document = json::parse(good);
    struct Damage {
        const char* pointer;
        json value;
        const char* message;
    };
    const Damage damages[] = {
        {"/format", "searchlight-walks/2", "'searchlight-walks/2' cannot be read (a newer version wrote it)"},
        {"/states", json::array(), "should hold 3 walks"},
        {"/states/0/chunks", -1, "/states/0/chunks"},
        {"/states/0/chunk_size", 9007199254740992, "/states/0/walks: does not fit the number of chunks"},
        {"/states/0/chunks", 0, "/states/0/walks: does not fit the number of chunks"},
        {"/states/0/walks", 2000, "/states/0/sums/0: is not of as many walks as the file says"},
        {"/estimators", 1, "/estimators: these are walks by another version of the estimators"},
        {"/problem", 5, "/problem: these are walks of another problem: it differs"},
        {"/problem/a~0b", 5, "/problem/a~0b: these are walks of another problem: /a~0b differs"},
        {"/states/0/chunks", 3, "does not have as many batches as the walk has chunks"},
        {"/states/0/sums/0", json::array({1, 2}), "is no list of sums"},
        {"/states/0/sums/1/4", "many", "holds what is no number"},
        {"/states/0/sums", json::array(), "the saved walks have other tallies"},
    };
    for (const Damage& damage : damages) {
        json bad = document;
        bad[json::json_pointer(damage.pointer)] = damage.value;
        writeFile(folder() / "walks.json", bad.dump());
        const Output output = run(half_space + "--walks 1000 --resume walks.json");
        EXPECT_EQ(output.exit_code, 3) << damage.pointer;
        EXPECT_THAT(output.err, testing::StartsWith("searchlight: walks.json:"));
        EXPECT_THAT(output.err, HasSubstr(damage.message));
        EXPECT_EQ(readFile(folder() / "walks.json"), bad.dump());
    }
    json older = document;
    older.erase("estimators");
    writeFile(folder() / "walks.json", older.dump());
    EXPECT_THAT(run(half_space + "--walks 1000 --resume walks.json").err,
                HasSubstr("another version of the estimators"));
    writeFile(folder() / "walks.json", good.substr(0, good.size() / 2));
    EXPECT_EQ(run(half_space + "--walks 1000 --resume walks.json").exit_code, 3);
}

TEST_F(Program, AReferenceStopsAtTheErrorAskedFor) {
    const Output output = run(half_space + "--walks 1e9 --until-error 1%");
    ASSERT_EQ(output.exit_code, 0) << output.err;
    const json document = json::parse(output.out);
    EXPECT_LT(document["walks"], 1e6);
    EXPECT_LE(document["diffuse"]["stderr"][0], 0.01 * document["diffuse"]["mean"][0].get<double>());
    EXPECT_EQ(run(half_space + "--until-error 2").exit_code, 2);
}

}  // namespace
}  // namespace searchlight
