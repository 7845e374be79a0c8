// Files that a job writes: what is said when one cannot be, and what is kept.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "program.h"

namespace searchlight {
namespace {

using nlohmann::json;
using testing::HasSubstr;

constexpr const char* layers = R"({"format": "searchlight-layers/1", "layers": [
    {"n": 1.4, "sigma_a": 0.1, "sigma_s": 1, "thickness_mm": 1}]})";

// So many walks that only a refusal before them ends in time.
const std::string endless = " --walks 1e13 --threads 1 ";
const std::string soon = "timeout -s KILL 60";

std::string mciOf(const std::string& output, const std::string& photons) {
    return output + " A\n" + photons + "\n0.01 0.01\n10 10 2\n1\n1\n1.4 1 10 0 0.1\n1\n";
}

TEST_F(Program, APathThatCannotBeWrittenIsNamedBeforeTheWork) {
    writeFile(folder() / "layers.json", layers);
    writeFile(folder() / "a.mci", "1.0\n2\n" + mciOf("a.mco", "1e12") + mciOf("no/b.mco", "10"));
    const std::string reference = "reference halfspace --sigma-a 0.1 --sigma-s 1 --eta 1.3" + endless;
    const std::string longer(300, 'a');
    const std::pair<std::string, std::string> cases[] = {
        {reference + "-o no/x.json", "no/x.json: cannot be written: No such file or directory"},
        {reference + "--resume no/x", "no/x: cannot be written: No such file or directory"},
        {reference + "-o " + longer, longer + ": cannot be written: File name too long"},
        {reference + "--resume " + longer, longer + ": cannot be written: File name too long"},
        {"reference slab --layers layers.json" + endless + "-o .", ".: cannot be written: is a folder"},
        {"reference sphere --material skin1" + endless + "-o no/x.exr", "no/x.exr: cannot be written"},
        {"mcml a.mci", "a.mci: run 2: no/b.mco: cannot be written: No such file or directory"},
        {"mcml a.mci -o no/x.json", "no/x.json: cannot be written"},
        {"render sphere --material skin1 -o no/x.png", "no/x.png: cannot be written"},
    };
    for (const auto& [arguments, message] : cases) {
        const Output output = run(arguments, soon);
        EXPECT_EQ(output.exit_code, 3) << arguments;
        EXPECT_THAT(output.err, HasSubstr(message));
    }
    EXPECT_EQ(fileCount(), 2u);
}

TEST_F(Program, NumbersAreShownWhereTheirFileCannotBeWritten) {
    if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
    const Output output = run("reference halfspace --sigma-a 0.1 --sigma-s 1 --walks 1e4 --json -o /dev/full");
    EXPECT_EQ(output.exit_code, 3);
    EXPECT_EQ(output.err, "searchlight: /dev/full: cannot be written: No space left on device\n");
    EXPECT_EQ(json::parse(output.out).at("walks"), 10'000);
}

TEST_F(Program, NamesNeedNotBeUtf8) {
    const std::string name = "b\xff.json";
    writeFile(folder() / name, layers);
    const Output output = run("reference slab --layers " + name + " --walks 1e4 --json --resume walks -o out.json");
    ASSERT_EQ(output.exit_code, 0) << output.err;
    EXPECT_EQ(json::parse(output.out), json::parse(readFile(folder() / "out.json")));
    writeFile(folder() / "a.mci", "1.0\n1\n" + mciOf("a\xff.mco", "100"));
    EXPECT_TRUE(json::accept(run("mcml a.mci --json").out));
    EXPECT_TRUE(std::filesystem::exists(folder() / "a\xff.mco"));
}

TEST_F(Program, AReferenceDoesNotOverwriteItsOwnFiles) {
    writeFile(folder() / "layers.json", layers);
    const std::string slab = "reference slab --layers layers.json" + endless;
    for (const auto& [arguments, option] : {std::pair(slab + "-o ./layers.json", "--layers"),
                                            std::pair(slab + "--resume walks -o ./walks", "--resume")}) {
        const Output output = run(arguments, soon);
        EXPECT_EQ(output.exit_code, 2);
        EXPECT_THAT(output.err, HasSubstr(std::string("-o would write over the file of ") + option));
    }
    EXPECT_EQ(readFile(folder() / "layers.json"), layers);
}

TEST_F(Program, McmlOverwritesNothingOfItsOwn) {
    const std::pair<std::string, std::string> cases[] = {
        {"1.0\n1\n" + mciOf("./a.mci", "1e12"), "run 1: it would write ./a.mci over the input file"},
        {"1.0\n2\n" + mciOf("x.mco", "1e12") + mciOf("./x.mco", "10"),
         "run 2: it would write ./x.mco over that of run 1"},
        {"1.0\n1\n" + mciOf("x.json", "1e12"), "run 1: it would write x.json over the JSON document of -o"},
    };
    for (const auto& [mci, message] : cases) {
        writeFile(folder() / "a.mci", mci);
        const Output output = run("mcml a.mci -o ../" + folder().filename().string() + "/x.json", soon);
        EXPECT_EQ(output.exit_code, 3);
        EXPECT_THAT(output.err, HasSubstr("a.mci: " + message));
        EXPECT_EQ(readFile(folder() / "a.mci"), mci);
    }
    writeFile(folder() / "a.mci", "1.0\n1\n" + mciOf("x.mco", "1e12"));
    EXPECT_THAT(run("mcml a.mci -o ./a.mci", soon).err, HasSubstr("-o would write over the input file"));
    EXPECT_EQ(fileCount(), 1u);
}

TEST_F(Program, McmlKeepsTheRunsBeforeAnInterruption) {
    writeFile(folder() / "a.mci", "1.0\n2\n" + mciOf("a.mco", "100") + mciOf("b.mco", "1e12"));
    const Output output = interrupt("mcml a.mci --json");
    EXPECT_EQ(output.exit_code, 130) << output.err;
    const json document = json::parse(output.out);
    EXPECT_EQ(document.at("interrupted"), true);
    EXPECT_EQ(document.at("runs").size(), 1u);
    EXPECT_TRUE(std::filesystem::exists(folder() / "a.mco"));
    EXPECT_FALSE(std::filesystem::exists(folder() / "b.mco"));
}

TEST_F(Program, CtrlCEndsABenchOfWalks) {
    EXPECT_EQ(run("bench transport --seconds 600", "timeout --preserve-status -s INT -k 60 3").exit_code, 130);
}

TEST_F(Program, CtrlCEndsTheWaitForAPipe) {
    const Output output =
        run("reference slab --layers pipe", "mkfifo pipe && timeout --preserve-status -s INT -k 60 3");
    EXPECT_EQ(output.exit_code, 130);
    EXPECT_EQ(output.err, "searchlight: interrupted\n");
}

TEST_F(Program, AReferenceThatIsInterruptedSaysSo) {
    writeFile(folder() / "layers.json", layers);
    const Output slab = interrupt("reference slab --layers layers.json --json -o slab.json" + endless);
    EXPECT_EQ(slab.exit_code, 130);
    EXPECT_EQ(json::parse(slab.out).at("interrupted"), true);
    EXPECT_EQ(json::parse(readFile(folder() / "slab.json")).at("interrupted"), true);
    const Output colours = interrupt("reference halfspace --material skin1 -o x.json" + endless);
    EXPECT_EQ(colours.exit_code, 130);
    EXPECT_THAT(colours.out, HasSubstr("\nG    not reached\nB    not reached\n"));
    EXPECT_THAT(colours.out, testing::EndsWith("interrupted\n"));
}

}  // namespace
}  // namespace searchlight
