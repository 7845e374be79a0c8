// References whose walks the processes of mpirun share.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "base/text.h"
#include "program.h"

namespace searchlight {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

class Ranks : public Program {
protected:
    void SetUp() override {
        Program::SetUp();
        if (std::string_view(SEARCHLIGHT_MPIRUN).empty()) GTEST_SKIP() << "built without SEARCHLIGHT_MPI";
        writeFile(folder() / "layers.json",
                  R"({"format": "searchlight-layers/1", "n_above": 1, "n_below": 1, "layers": [
                      {"n": 1.5, "sigma_a": 0.05, "sigma_s": 2, "g": 0, "thickness_mm": 1},
                      {"n": 1.4, "sigma_a": 0.01, "sigma_s": 8, "g": 0.8, "thickness_mm": 2}]})");
        writeFile(folder() / "box.obj",
                  "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 0 0 1\nv 1 0 1\nv 0 1 1\nv 1 1 1\n"
                  "f 1 3 2\nf 2 3 4\nf 5 6 7\nf 6 8 7\nf 1 2 5\nf 2 6 5\n"
                  "f 3 7 4\nf 4 7 8\nf 1 5 3\nf 3 5 7\nf 2 4 6\nf 4 8 6\n");
    }

    json states() const {
        json list = json::parse(readFile(folder() / "walks.json")).at("states");
        for (json& state : list)
            if (!state.is_null()) state.erase("seconds");
        return list;
    }

    static std::string mpirun(int processes) {
        return fmt::format("{} --allow-run-as-root --oversubscribe -n {}", SEARCHLIGHT_MPIRUN, processes);
    }
};

// A document without what the clock says, and how many cores mpirun let a process have.
json numbers(const std::string& text) {
    json document = json::parse(text);
    for (const char* key : {"seconds", "threads"}) document.erase(key);
    return document;
}

// Empty, or the first thing that differs: documents are long.
std::string difference(const json& a, const json& b) {
    const json changes = json::diff(a, b);
    return changes.empty() ? "" : changes.front().dump();
}

std::size_t count(const std::string& text, std::string_view what) {
    std::size_t found = 0;
    for (std::size_t at = text.find(what); at != text.npos; at = text.find(what, at + 1)) ++found;
    return found;
}

const std::string half_space =
    "reference halfspace --sigma-a 0.1 --sigma-s 0.9 --eta 1.3 --edges 0,1,3 --json --seed 5 ";

TEST_F(Ranks, EveryReferenceHasTheNumbersOfOneProcess) {
    const std::string body = " --sigma-a 0.3 --sigma-s 2 --g 0.5 --eta 1.3 --walks 4e3 --size 8x8 --json ";
    int processes = 2;
    for (const std::string& reference : std::vector<std::string>{
             half_space + "--walks 1e6", half_space + "--walks 1e5 --g 0.8",
             half_space + "--walks 1e5 --angle-deg 40 --estimator analogue",
             half_space + "--walks 1e5 --grid 8 --grid-extent 2 --beam gaussian --beam-radius 0.5",
             half_space + "--walks 1e8 --until-error 1%", "reference slab --layers layers.json --walks 3e4 --json",
             "reference slab --layers layers.json --walks 3e4 --json --estimator analogue --maps",
             "reference slab --layers layers.json --walks 1e7 --json --until-error 2% --angle-deg 30",
             "reference sphere" + body, "reference sphere --light dir:1,1,1 --radiance" + body,
             "reference sphere --until-error 5% --light dir:1,1,1 --walks 1e6 --sigma-a 1 --sigma-s 2 --size 8x8 "
             "--json",
             "reference mesh box.obj --scale 3" + body, "reference mesh box.obj --scale 3 --radiance" + body,
             "reference mesh box.obj --scale 3 --light dir:1,2,3 --radiance" + body}) {
        SCOPED_TRACE(reference);
        const Output one = run(reference), shared = run(reference, mpirun(processes));
        ASSERT_EQ(one.exit_code, 0) << one.err;
        ASSERT_EQ(shared.exit_code, 0) << shared.err;
        EXPECT_EQ(difference(numbers(shared.out), numbers(one.out)), "") << processes << " processes";
        processes = processes == 4 ? 2 : processes + 1;
    }
}

// Blocks of chunks are the same for all; those of one process end elsewhere.
TEST_F(Ranks, ProcessesWithDifferentNumbersOfThreadsAgree) {
    const std::string walk = half_space + "--walks 1e6 --threads ";
    const std::string program = SEARCHLIGHT_PROGRAM;
    const Output one = run(walk + "1"), mixed = run(walk + "1 : -n 1 '" + program + "' " + walk + "3", mpirun(1));
    ASSERT_EQ(mixed.exit_code, 0) << mixed.err;
    json here = numbers(one.out), there = numbers(mixed.out);
    for (json* document : {&here, &there}) document->erase("job");
    EXPECT_EQ(difference(there, here), "");
}

TEST_F(Ranks, WalksGoOnWithAnotherNumberOfProcesses) {
    for (const std::string& reference : std::vector<std::string>{
             half_space, "reference slab --layers layers.json --json ",
             "reference sphere --sigma-a 0.3 --sigma-s 2 --size 8x8 --light dir:1,1,1 --json ",
             "reference mesh box.obj --scale 3 --sigma-a 0.3 --sigma-s 2 --size 8x8 --radiance --json "}) {
        SCOPED_TRACE(reference);
        const std::string few = reference + "--resume walks.json --walks 2048 ",
                          many = reference + "--resume walks.json --walks 8192 ";
        ASSERT_EQ(run(few).exit_code, 0);
        const json alone = states();
        std::filesystem::remove(folder() / "walks.json");
        ASSERT_EQ(run(few, mpirun(3)).exit_code, 0);
        EXPECT_EQ(difference(states(), alone), "");
        const std::string saved = readFile(folder() / "walks.json");
        const Output one = run(many);
        writeFile(folder() / "walks.json", saved);
        const Output two = run(many, mpirun(2));
        ASSERT_EQ(two.exit_code, 0) << two.err;
        EXPECT_EQ(difference(numbers(two.out), numbers(one.out)), "");
        std::filesystem::remove(folder() / "walks.json");
    }
}

// The one that writes reads: the others may be on machines that have no such file.
TEST_F(Ranks, OneProcessReadsWhatIsResumed) {
    const std::string walk = half_space + "--walks 8388608 --resume walks.json";
    ASSERT_EQ(run(half_space + "--walks 4194304 --resume walks.json").exit_code, 0);
    std::filesystem::create_directory(folder() / "elsewhere");
    const std::string program = SEARCHLIGHT_PROGRAM;
    const Output resumed = run(walk + " : -n 2 --wdir elsewhere '" + program + "' " + walk, mpirun(1));
    ASSERT_EQ(resumed.exit_code, 0) << resumed.err;
    EXPECT_FALSE(std::filesystem::exists(folder() / "elsewhere/walks.json"));
    json straight = numbers(run(half_space + "--walks 8388608").out), there = numbers(resumed.out);
    for (json* document : {&straight, &there}) document->erase("job");
    EXPECT_EQ(difference(there, straight), "");
}

TEST_F(Ranks, OneMistakeIsSaidOnce) {
    writeFile(folder() / "bad.json", "{");
    struct Mistake {
        std::string arguments;
        int exit_code;
        const char* message;
    };
    for (const Mistake& mistake : {Mistake{half_space + "--walks 0", 2, "walks"},
                                   {half_space + "--no-such-option 1", 2, "no-such-option"},
                                   {half_space + "--walks 1000 --resume bad.json", 3, "bad.json"},
                                   {half_space + "--walks 1000 -o missing/part.json", 3, "missing/part.json"},
                                   {"reference slab --layers none.json", 3, "none.json"}}) {
        SCOPED_TRACE(mistake.arguments);
        const Output output = run(mistake.arguments, "timeout 60 " + mpirun(3));
        EXPECT_EQ(output.exit_code, mistake.exit_code);
        EXPECT_EQ(count(output.err, "searchlight: "), 1u) << output.err;
        EXPECT_THAT(output.err, HasSubstr(mistake.message));
    }
}

// Its place in the job is said, since the others know nothing of it; they do not wait for ever.
TEST_F(Ranks, AMistakeOfOneProcessEndsAll) {
    const std::string program = SEARCHLIGHT_PROGRAM;
    const std::string walk = half_space + "--walks 1e11";
    const Output output =
        run(walk + " : -n 1 '" + program + "' " + walk + " --no-such-option 1", "timeout 60 " + mpirun(1));
    EXPECT_EQ(output.exit_code, 2);
    EXPECT_THAT(output.err, HasSubstr("searchlight: process 2 of 2: "));
    EXPECT_EQ(count(output.err, "searchlight: "), 1u) << output.err;
}

TEST_F(Ranks, OneProcessAnswersWhatIsNotShared) {
    for (const std::string arguments : {"models --json", "reference halfspace --print-job --walks 10"})
        EXPECT_TRUE(json::accept(run(arguments, mpirun(3)).out)) << arguments;
    EXPECT_EQ(run("--version", mpirun(3)).out, run("--version").out);
}

TEST_F(Ranks, CtrlCLeavesAValidFileThatGoesOn) {
    // A busy machine may take more than the second that mpirun grants.
    const Output stopped =
        run(half_space + "--walks 1e13 --resume walks.json -o part.json",
            "timeout --preserve-status -s INT 6 " + mpirun(3) + " --mca odls_base_sigkill_timeout 60");
    EXPECT_NE(stopped.exit_code, 0);
    const json part = json::parse(readFile(folder() / "part.json"));
    EXPECT_EQ(part["interrupted"], true);
    const double walks = part["walks"];
    EXPECT_GT(walks, 0);
    const Output again = run(half_space + "--walks " + numberText(walks) + " --resume walks.json");
    ASSERT_EQ(again.exit_code, 0) << again.err;
    for (const char* key : {"diffuse", "profile", "mean_r2_mm2", "walks", "collisions"})
        EXPECT_EQ(json::parse(again.out)[key], part[key]) << key;
}

TEST_F(Ranks, OneProcessSpeaksOfProgress) {
    // Nothing is said of a walk that ends at once.
    const Output output = run(half_space + "--walks 1e5", mpirun(3));
    EXPECT_EQ(output.err, "");
}

}  // namespace
}  // namespace searchlight
