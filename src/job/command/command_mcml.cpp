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

// Before hours of walking, not after: every run can be walked, and written without harm to another file of the job.
void checkRuns(const std::vector<McmlRun>& runs, const std::string& path, const Job& job, const Options& options) {
    for (std::size_t i = 0; i < runs.size(); ++i) try {
            const std::string& output = runs[i].output;
            slabLayout(slabProblem(runs[i]), walkOf(runs[i], job, options));
            const auto refuse = [&](std::string_view what) {
                throw inputError(fmt::format("it would write {} over {}", output, what),
                                 "give its output another name");
            };
            if (sameFile(output, path)) refuse("the input file");
            if (!job.output.empty() && sameFile(output, job.output)) refuse("the JSON document of -o");
            for (std::size_t j = 0; j < i; ++j)
                if (sameFile(output, runs[j].output)) refuse(fmt::format("that of run {}", j + 1));
            checkWritable(output);
        } catch (const Error& error) {
            throw inputError(fmt::format("run {}: {}", i + 1, error.file.empty() ? error.message : error.what()),
                             error.file.empty() ? error.hint : std::string())
                .at(path);
        }
    if (!job.output.empty() && sameFile(job.output, path))
        throw inputError("-o would write over the input file", "give another name").at(path);
}

JobResult runMcml(const Job& job, Engine&, Observer& observer) {
    const Options options(job);
    const std::string& path = options.text("input");
    const std::vector<McmlRun> runs = parseMci(readFile(path), path);
    checkRuns(runs, path, job, options);

    JobResult result;
    Json document = documentJson("searchlight-mcml/1", job);
    document["per"] = "incident";
    document["runs"] = Json::array();
    for (std::size_t i = 0; i < runs.size(); ++i) {
        const McmlRun& run = runs[i];
        const SlabProblem problem = slabProblem(run);
        SlabOptions walk = walkOf(run, job, options);
        SlabResult walked;
        try {
            walked = walkSlab(problem, walk, observer);
        } catch (const Error& error) {
            if (error.kind != ErrorKind::interrupted || i == 0) throw;
            result.interrupted = true;
            break;
        }
        McmlRun written = run;
        written.photons = walk.walks;
        // As each run ends, so that an interruption keeps those before. Names are relative to the working directory, as
        // MCML has them.
        writeOutput(result, [&] { writeFile(run.output, mcoText(mcmlOutput(written, walked))); });
        walk.maps = false;  // they are in the .mco file
        Json json{{"file", run.output}};
        const Json numbers = slabJson(problem, walk, walked);
        for (const auto& [key, value] : numbers.items()) json[key] = value;
        document["runs"].push_back(std::move(json));
        result.text += fmt::format("run {} of {}: {}, {:.3g} photons\n{}\n", i + 1, runs.size(), run.output,
                                   static_cast<double>(walk.walks), slabText(problem, walked));
    }
    if (result.interrupted) {
        document["interrupted"] = true;
        result.text += fmt::format("interrupted after {} of {} runs\n", document["runs"].size(), runs.size());
    }
    result.json = jsonText(document);
    writeDocument(result, job);
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
