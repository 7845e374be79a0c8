// reference slab: a beam on plane layers by Monte Carlo, or without noise.
#include <fmt/format.h>

#include <cmath>

#include "base/error.h"
#include "base/files.h"
#include "job/beam_option.h"
#include "job/command_table.h"
#include "job/engine.h"
#include "job/reference/saved_walks.h"
#include "job/reference/slab_json.h"
#include "job/shared_options.h"
#include "transport/exact/ordinate_slab.h"
#include "transport/exact/ordinate_totals.h"
#include "transport/mcml/mcml_run.h"
#include "transport/walk/radial_edges.h"

namespace searchlight {

namespace {

struct SlabSubject {
    std::string name;
    SlabProblem problem;
    SlabOptions options;
};

McmlRun runOf(const std::string& path, int number) {
    const std::vector<McmlRun> runs = parseMci(readFile(path), path);
    if (number > static_cast<int>(runs.size()))
        throw inputError(fmt::format("no run {}: the file has {}", number, runs.size())).at(path);
    return runs[static_cast<std::size_t>(number) - 1];
}

// 10 transport mean free paths of the first layer that does anything.
double naturalRange(const SlabProblem& problem) {
    for (const SlabLayer& layer : problem.layers) {
        if (layer.clear()) continue;
        const double range = 10 / (layer.sigma_a + (1 - layer.meanCosine()) * layer.sigma_s);
        if (!(range <= 1e9))
            throw inputError("a layer is too clear for radii to be chosen", "give --radii-max and --depth");
        return range;
    }
    return 10;
}

// The slab down to its end, or as deep as wide where it has none.
double naturalDepth(const SlabProblem& problem) {
    double depth = 0;
    for (const SlabLayer& layer : problem.layers)
        depth += std::isinf(layer.thickness_mm) ? naturalRange(problem) : layer.thickness_mm;
    return depth > 0 ? depth : 1;
}

SlabSubject slabOf(const Options& options) {
    if (options.given("layers") == options.given("mci"))
        throw usageError("a slab needs either --layers or --mci", "a .json or an .mci file that states its layers");
    SlabSubject subject;
    if (options.given("mci")) {
        subject.name = options.text("mci");
        const McmlRun run = runOf(subject.name, static_cast<int>(options.number("run")));
        subject.problem = slabProblem(run);
        subject.options = slabOptions(run);
        subject.options.maps = false;
    } else {
        if (options.given("run")) throw usageError("--run needs --mci", "it chooses a run of that file");
        subject.name = options.text("layers");
        subject.problem = parseLayers(readFile(subject.name), subject.name);
    }
    subject.problem.angle_deg = options.number("angle_deg");
    subject.problem.beam = beamOf(options);
    return subject;
}

// What the sums depend on, but for the number of walks.
Json problemJson(const SlabProblem& problem, const SlabOptions& options) {
    Json json{{"n_above", problem.n_above},   {"n_below", problem.n_below}, {"angle_deg", problem.angle_deg},
              {"edges_mm", options.edges_mm}, {"angles", options.angles},   {"depths", options.depths},
              {"depth_mm", options.depth_mm}, {"maps", options.maps},       {"layers", Json::array()}};
    // What came later is named only where it is used, so that older sums go on.
    if (options.grid > 0) json["grid"] = {options.grid, options.grid_extent_mm};
    if (problem.beam.kind != BeamShape::pencil) json["beam"] = {problem.beam.kind, problem.beam.radius};
    if (options.gl) json["backend"] = "gl";
    if (options.estimator == SlabEstimator::best) json["estimator"] = "best";
    for (const SlabLayer& layer : problem.layers) {
        Json& one = json["layers"].emplace_back(Json{{"n", layer.n},
                                                     {"sigma_a", layer.sigma_a},
                                                     {"sigma_s", layer.sigma_s},
                                                     {"g", layer.g},
                                                     {"thickness_mm", layer.thickness_mm}});
        if (layer.phase) one["phase"] = {layer.phase->angles_deg, layer.phase->values};
    }
    return json;
}

// Says why where there is no exact solution.
void refuseExact(const Options& options, const SlabSubject& subject) {
    for (const char* name : {"walks", "estimator", "depths", "depth", "resume", "until_error"})
        if (options.given(name))
            throw usageError(fmt::format("--exact and --{} exclude each other",
                                         name == std::string_view("until_error") ? "until-error" : name),
                             "give one of the two");
    if (options.toggle("maps") || options.number("grid") > 0)
        throw usageError("--exact has no --maps and no --grid", "it solves for R(r), T(r), angles and totals");
    if (options.text("backend") == "gl")
        throw usageError("--backend gl and --exact exclude each other", "OpenGL walks");
    if (const std::string reason = whyNotOrdinateTotals(subject.problem); !reason.empty())
        throw usageError(fmt::format("{} has no exact solution: {}", subject.name, reason), ordinateSlabsCovered());
    const std::string reason = whyNotOrdinateSlab(subject.problem);
    for (const char* name : {"edges", "bins", "radii_max"})
        if (options.given(name) && !reason.empty())
            throw usageError(fmt::format("{} has no exact R(r) and T(r): {}", subject.name, reason),
                             "without radii --exact gives totals and angles");
}

JobResult solveReferenceSlab(const Job& job, const SlabSubject& subject, Observer& observer) {
    const std::string no_profile = whyNotOrdinateSlab(subject.problem);
    const SlabResult solved = no_profile.empty() ? solveSlab(subject.problem, subject.options, observer)
                                                 : solveSlabTotals(subject.problem, subject.options.angles);
    Json document = documentJson("searchlight-slab/1", job);
    document["per"] = "incident";
    const Json numbers = exactSlabJson(subject.problem, subject.options, solved);
    for (const auto& [key, value] : numbers.items()) document[key] = value;
    document["estimator"] = "exact";
    JobResult result;
    result.json = jsonText(document);
    result.text = fmt::format("{}, exact, {} deg, per unit incident flux\n{}", subject.name, subject.problem.angle_deg,
                              exactSlabText(subject.problem, solved));
    if (!no_profile.empty()) result.text += fmt::format("no R(r) and T(r): {}\n", no_profile);
    writeDocument(result, job);
    return result;
}

JobResult runReferenceSlab(const Job& job, Engine& engine, Observer& observer) {
    const Options options(job);
    SlabSubject subject = slabOf(options);
    SlabOptions& walk = subject.options;
    const bool grid_given = options.given("mci");  // the file has one, which options override
    const auto wants = [&](const char* option) { return !grid_given || options.given(option); };
    if (wants("walks")) walk.walks = static_cast<std::uint64_t>(options.number("walks"));
    if (option::edgesGiven(options)) {
        walk.edges_mm = options.list("edges");
    } else if (wants("bins") || options.given("radii_max")) {
        const double range = options.number("radii_max");
        walk.edges_mm =
            linearEdges(static_cast<int>(options.number("bins")), range > 0 ? range : naturalRange(subject.problem));
    }
    if (wants("angles")) walk.angles = static_cast<int>(options.number("angles"));
    if (wants("depths")) walk.depths = static_cast<int>(options.number("depths"));
    if (wants("depth"))
        walk.depth_mm = options.number("depth") > 0 ? options.number("depth") : naturalDepth(subject.problem);
    walk.maps = options.toggle("maps");
    walk.grid = static_cast<int>(options.number("grid"));
    walk.grid_extent_mm = options.number("grid_extent");
    option::requireGridExtent(options);
    walk.seed = job.seed;
    walk.threads = static_cast<int>(options.number("threads"));
    if (options.toggle("exact")) {
        refuseExact(options, subject);
        return solveReferenceSlab(job, subject, observer);
    }
    if (options.text("backend") == "gl") {
        if (options.given("threads"))
            throw usageError("--backend gl has no --threads", "the device has its own; --threads is for --backend cpu");
        if (options.given("estimator") && options.text("estimator") != "analogue")
            throw usageError("--backend gl has no --estimator best", "OpenGL walks by the analogue estimator");
        walk.gl = &engine.context();
    }
    if (options.text("estimator") == "best" && !walk.gl) walk.estimator = SlabEstimator::best;
    SavedWalks saved(options, job, problemJson(subject.problem, walk), 1, observer);
    walk.control = saved.control(0);
    const SlabResult walked = walkSlab(subject.problem, walk, observer);
    JobResult result;
    saved.save(result);
    if (walked.interrupted && walked.walks == 0) throw interruptedError();

    Json document = documentJson("searchlight-slab/1", job);
    document["per"] = "incident";
    const Json numbers = slabJson(subject.problem, walk, walked);
    for (const auto& [key, value] : numbers.items()) document[key] = value;
    document["estimator"] = walked.estimator == SlabEstimator::best ? "best" : "analogue";
    document["foresees"] = walked.foresees;
    document["backend"] = options.text("backend");
    if (walked.interrupted) document["interrupted"] = true;
    result.json = jsonText(document);
    result.text =
        fmt::format("{}, {:.3g} walks, {} deg, per unit incident flux\n{}", subject.name,
                    static_cast<double>(walked.walks), subject.problem.angle_deg, slabText(subject.problem, walked));
    result.interrupted = walked.interrupted;
    if (walked.interrupted) result.text += "interrupted\n";
    writeDocument(result, job);
    return result;
}

}  // namespace

Command referenceSlabCommand() {
    return {
        .name = "reference slab",
        .summary = "Walk a pencil beam on plane layers by unbiased Monte Carlo",
        .example = "searchlight reference slab --layers layers.json --walks 1e6 --json",
        .options = {{.name = "layers",
                     .type = ParamType::path,
                     .value = std::string(),
                     .doc = "the slab: a searchlight-layers/1 file"},
                    {.name = "mci",
                     .type = ParamType::path,
                     .value = std::string(),
                     .doc = "or an input file of MCML, with its grid and number of photons"},
                    {.name = "run",
                     .type = ParamType::integer,
                     .min = 1,
                     .max = 32767,
                     .value = 1.0,
                     .doc = "which run of that file"},
                    option::walks(1e6, "walks", "random walks"),
                    option::angle(),
                    option::beam(),
                    option::beamRadius(),
                    option::edges(),
                    option::radiiMax(),
                    option::bins(100),
                    {.name = "angles",
                     .type = ParamType::integer,
                     .min = 1,
                     .max = 1e4,
                     .value = 30.0,
                     .doc = "equal parts of 90 deg, for what leaves"},
                    {.name = "depths",
                     .type = ParamType::integer,
                     .min = 1,
                     .max = 1e6,
                     .value = 100.0,
                     .doc = "equal parts of the depth, for what is absorbed"},
                    {.name = "depth",
                     .unit = "mm",
                     .min = 0,
                     .max = option::unlimited,
                     .value = 0.0,
                     .doc = "largest depth; 0: chosen from the slab"},
                    {.name = "maps",
                     .type = ParamType::toggle,
                     .value = false,
                     .doc = "also A(r, z), fluence(r, z), R(r, alpha), T(r, alpha)"},
                    option::grid("R(x, y) and T(x, y)"),
                    option::gridExtent(),
                    {.name = "estimator",
                     .type = ParamType::choice,
                     .value = std::string("best"),
                     .choices = {"analogue", "best"},
                     .doc = "best: R, T, A follow controls of known mean, and walks that foresee where light "
                            "leaves know R(r), T(r) and angles, unless a pilot finds no gain; these have no part in "
                            "--grid, --maps, clear layers, tabulated phase functions"},
                    {.name = "exact",
                     .type = ParamType::toggle,
                     .value = false,
                     .doc = "solve totals, angles and, at normal incidence, R(r) and T(r) without walks: |g| up to "
                            "0.9; stderr then estimates the numerical error"},
                    option::walkBackend(),
                    option::threads(),
                    option::untilError("R, T and A"),
                    option::resume()},
        .uses_seed = true,
        .shares_walks = true,
        .output = "the JSON document",
        .run = runReferenceSlab};
}

}  // namespace searchlight
