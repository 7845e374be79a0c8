// mcml: the runs of an .mci file, each into the .mco file that it names.
#include <fmt/format.h>

#include "base/error.h"
#include "base/files.h"
#include "job/command_table.h"
#include "job/reference/slab_json.h"
#include "job/shared_options.h"
#include "transport/mcml/mcml_run.h"

namespace searchlight {

namespace {

SlabOptions walkOf(const McmlRun& run, const Job& job, const Options& options) {
    SlabOptions walk = slabOptions(run);
    if (options.given("walks")) walk.walks = static_cast<std::uint64_t>(options.number("walks"));
    walk.seed = job.seed;
    walk.estimator = SlabEstimator::best;  // its controls; all the rest is that of the analogue walk
    walk.threads = static_cast<int>(options.number("threads"));
    return walk;
}

JobResult runMcml(const Job& job, Engine&, Observer& observer) {
    const Options options(job);
    const std::string& path = options.text("input");
    const std::vector<McmlRun> runs = parseMci(readFile(path), path);
    for (std::size_t i = 0; i < runs.size(); ++i) try {  // before hours of walking, not after
            slabLayout(slabProblem(runs[i]), walkOf(runs[i], job, options));
        } catch (const Error& error) {
            throw inputError(fmt::format("run {}: {}", i + 1, error.message), error.hint).at(path);
        }

    JobResult result;
    Json document = documentJson("searchlight-mcml/1", job);
    document["per"] = "incident";
    document["runs"] = Json::array();
    std::vector<std::string> files;
    for (std::size_t i = 0; i < runs.size(); ++i) {
        const McmlRun& run = runs[i];
        const SlabProblem problem = slabProblem(run);
        SlabOptions walk = walkOf(run, job, options);
        const SlabResult walked = walkSlab(problem, walk, observer);
        McmlRun written = run;
        written.photons = walk.walks;
        files.push_back(mcoText(mcmlOutput(written, walked)));
        walk.maps = false;  // they are in the .mco file
        Json json{{"file", run.output}};
        const Json numbers = slabJson(problem, walk, walked);
        for (const auto& [key, value] : numbers.items()) json[key] = value;
        document["runs"].push_back(std::move(json));
        result.text += fmt::format("run {} of {}: {}, {:.3g} photons\n{}\n", i + 1, runs.size(), run.output,
                                   static_cast<double>(walk.walks), slabText(problem, walked));
    }
    // Names are relative to the working directory, as MCML has them.
    for (std::size_t i = 0; i < runs.size(); ++i) writeFile(runs[i].output, files[i]);
    result.json = document.dump(1);
    if (!job.output.empty()) writeFile(job.output, result.json + "\n");
    return result;
}

}  // namespace

Command mcmlCommand() {
    return {.name = "mcml",
            .summary = "Walk the runs of an MCML input file and write its output files",
            .example = "searchlight mcml sample.mci",
            .options = {{.name = "input",
                         .type = ParamType::path,
                         .doc = "an .mci file, version 1.0 or 2.0",
                         .required = true},
                        option::walks(1e6, "walks", "random walks of every run; absent: the photons of the file"),
                        option::threads()},
            .positional = "input",
            .uses_seed = true,
            .output = "a JSON document with every standard error, beside the .mco files",
            .run = runMcml};
}

}  // namespace searchlight
