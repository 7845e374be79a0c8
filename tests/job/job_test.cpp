#include "job/job.h"

#include "base/error.h"
#include "base/files.h"
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
        EXPECT_TRUE(std::string(command.example).starts_with("searchlight " + std::string(command.name))) << command.name;
        EXPECT_FALSE(command.summary.empty()) << command.name;
        EXPECT_NE(command.run, nullptr) << command.name;
        for (const Param& param : command.options) EXPECT_FALSE(param.doc.empty()) << command.name << " " << param.name;
    }
}

TEST(Job, DefaultsOfCommandsAreValidValues) {
    for (const Command& command : commands())
        for (const Param& param : command.options) {
            // An empty list is the one default that a user cannot type: it stands for "absent".
            if (param.required || param.value == ParamValue(std::vector<double>{})) continue;
            EXPECT_NO_THROW(checkValue(param, param.value)) << command.name << " " << param.name;
        }
}

struct IllegalJob {
    const char* text;
    const char* message;
};

class IllegalJobs : public testing::TestWithParam<IllegalJob> {};

TEST_P(IllegalJobs, AreRefusedWithOneMessage) {
    try {
        parseJob(GetParam().text, "job.json");
        FAIL() << "accepted: " << GetParam().text;
    } catch (const Error& error) {
        EXPECT_STREQ(error.what(), GetParam().message);
        EXPECT_EQ(error.kind, ErrorKind::input);
    }
}

const IllegalJob illegal_jobs[] = {
    {"", "job.json:1:1: not valid JSON: unexpected end of input"},
    {"{\"format\": \"searchlight-job/1\",\n \"command\" \"profile\"}", ""},
    {"[]", "job.json:1:1: a job is a JSON object ({\"format\": \"searchlight-job/1\", ...})"},
    {"{}", "job.json:1:1: no format (expected \"format\": \"searchlight-job/1\")"},
    {"{\"format\": 1}", ""},
    {"{\"format\": \"searchlight-scene/1\"}", ""},
    {"{\"format\": \"searchlight-job/2\", \"command\": \"profile\"}", ""},
    {"{\"format\": \"searchlight-job/x\"}", ""},
    {"{\"format\": \"searchlight-job/1\"}", ""},
    {"{\"format\": \"searchlight-job/1\", \"command\": 7}", ""},
    {"{\"format\": \"searchlight-job/1\", \"command\": \"profil\"}", ""},
    {"{\"format\": \"searchlight-job/1\", \"command\": \"profile\", \"optoins\": {}}", ""},
    {"{\"format\": \"searchlight-job/1\", \"command\": \"profile\", \"options\": []}", ""},
    {"{\"format\": \"searchlight-job/1\", \"command\": \"profile\", \"options\": {\"radius\": 1}}", ""},
    {"{\"format\": \"searchlight-job/1\", \"command\": \"profile\", \"options\": {\"radii\": [1, -1]}}", ""},
    {"{\"format\": \"searchlight-job/1\", \"command\": \"profile\", \"options\": {\"radii\": \"1,2\"}}", ""},
    {"{\"format\": \"searchlight-job/1\", \"command\": \"profile\", \"options\": {\"per\": \"photon\"}}", ""},
    {"{\"format\": \"searchlight-job/1\", \"command\": \"profile\", \"options\": {\"angle_deg\": 90}}", ""},
    {"{\"format\": \"searchlight-job/1\", \"command\": \"invert\", \"options\": {\"Rdr\": 0.5}}", ""},
    {"{\"format\": \"searchlight-job/1\", \"command\": \"reference halfspace\", \"options\": {\"walks\": 1.5}}", ""},
    {"{\"format\": \"searchlight-job/1\", \"command\": \"reference halfspace\", \"seed\": -1}", ""},
    {"{\"format\": \"searchlight-job/1\", \"command\": \"reference halfspace\", \"seed\": 1e300}", ""},
    {"{\"format\": \"searchlight-job/1\", \"command\": \"profile\", \"output\": 3}", ""},
    {"{\"format\": \"searchlight-job/1\", \"command\": \"profile\",\n \"scene\": {}}", ""},
    {"{\"format\": \"searchlight-job/1\", \"command\": \"profile\",\n \"scene\": {\"format\": \"searchlight-scene/1\",\n  \"material\": 4}}", ""},
    {"{\"format\": \"searchlight-job/1\", \"command\": \"profile\", \"command\": \"check\"}", ""},
};

INSTANTIATE_TEST_SUITE_P(Job, IllegalJobs, testing::ValuesIn(illegal_jobs));

}  // namespace
}  // namespace searchlight
