#include "job/job.h"

#include "illegal/messages.h"
#include "job/command.h"

namespace searchlight {
namespace {

TEST(Job, ReadsBackAsWritten) {
    Job job;
    job.command = "plot pencil";
    job.scene.material = {};
    job.scene.material.id.clear();
    job.scene.material.sigma_a = {0.1, 0.2, 1.0 / 3};
    job.scene.material.sigma_s = {2};
    job.options["models"] = std::string("dipole,better_dipole:Moments=exact");
    job.options["reference_walks"] = 1e6;
    job.options["channel"] = std::string("luminance");
    job.seed = 9007199254740992;  // 2^53: the largest a JSON number holds exactly
    job.output = "out/\"quoted\" ü.svg";
    const std::string text = jobJson(job);
    const Job read = parseJob(text, "job.json");
    EXPECT_EQ(jobJson(read), text);
    EXPECT_EQ(read.seed, job.seed);
    EXPECT_EQ(read.output, job.output);
    EXPECT_EQ(read.options, job.options);
    EXPECT_EQ(read.scene.material.sigma_a, job.scene.material.sigma_a);
}

TEST(Job, EveryCommandHasAnExampleThatNamesIt) {
    for (const Command& command : commands()) {
        EXPECT_TRUE(std::string(command.example).starts_with("searchlight " + std::string(command.name)))
            << command.name;
        EXPECT_FALSE(command.summary.empty()) << command.name;
        EXPECT_NE(command.run, nullptr) << command.name;
        for (const Param& param : command.options) EXPECT_FALSE(param.doc.empty()) << command.name << " " << param.name;
    }
}

TEST(Job, DefaultsOfCommandsAreValidValues) {
    for (const Command& command : commands())
        for (const Param& param : command.options) {
            // Empty lists and paths are the defaults that a user cannot type: they stand for "absent".
            if (param.required || valueText(param.value).empty()) continue;
            EXPECT_NO_THROW(checkValue(param, param.value)) << command.name << " " << param.name;
        }
}

TEST(Job, EveryIllegalFileFailsWithItsMessage) {
    expectMessages("jobs", [](auto text, auto path) { parseJob(text, path); });
}

}  // namespace
}  // namespace searchlight
