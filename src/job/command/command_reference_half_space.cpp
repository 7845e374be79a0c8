// reference halfspace: the searchlight problem by Monte Carlo, or exactly.
#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "base/text.h"
#include "job/beam_option.h"
#include "job/command_table.h"
#include "job/json.h"
#include "job/plot/curves.h"
#include "job/reference/saved_walks.h"
#include "job/shared_options.h"
#include "transport/exact/exact_half_space.h"
#include "transport/exact/ordinate_half_space.h"
#include "transport/walk/radial_edges.h"

namespace searchlight {

namespace {

Json estimatesJson(const ReferenceRun& run, Estimate HalfSpaceTally::*member, HalfSpaceTally HalfSpaceResult::*order) {
    Json mean = Json::array(), error = Json::array();
    for (int c = 0; c < run.medium.channels; ++c) {
        const auto& walked = run.channels[static_cast<std::size_t>(c)];
        mean.push_back(walked ? Json((*walked.*order.*member).mean) : Json());
        error.push_back(walked ? Json((*walked.*order.*member).standard_error) : Json());
    }
    return {{"mean", mean}, {"stderr", error}};
}

Json rowsJson(const ReferenceRun& run, std::vector<double> HalfSpaceTally::*member,
              HalfSpaceTally HalfSpaceResult::*order) {
    Json rows = Json::array();
    for (int c = 0; c < run.medium.channels; ++c) {
        const auto& walked = run.channels[static_cast<std::size_t>(c)];
        rows.push_back(walked ? Json(*walked.*order.*member) : Json());
    }
    return rows;
}

// The tallies of one order of scattering.
Json tallyJson(const ReferenceRun& run, HalfSpaceTally HalfSpaceResult::*order, int grid, double grid_extent_mm) {
    Json tally;
    tally["diffuse"] = estimatesJson(run, &HalfSpaceTally::total, order);
    tally["profile"] = {{"edges_mm", run.edges_mm},
                        {"Rd", rowsJson(run, &HalfSpaceTally::Rd, order)},
                        {"stderr", rowsJson(run, &HalfSpaceTally::standard_error, order)},
                        {"beyond", rowsJson(run, &HalfSpaceTally::beyond, order)}};
    tally["mean_x_mm"] = estimatesJson(run, &HalfSpaceTally::mean_x_mm, order);
    tally["mean_r2_mm2"] = estimatesJson(run, &HalfSpaceTally::mean_r2_mm2, order);
    if (grid > 0)
        tally["grid"] = {{"cells", grid},
                         {"extent_mm", grid_extent_mm},
                         {"order", "row-major, y then x, both ascending"},
                         {"Rd", rowsJson(run, &HalfSpaceTally::grid, order)},
                         {"stderr", rowsJson(run, &HalfSpaceTally::grid_standard_error, order)}};
    return tally;
}

// Equal annuli to a radius that is given or solved for; else they widen outwards, as in plots.
std::vector<double> edgesOf(const Options& options, const Medium& medium) {
    if (option::edgesGiven(options)) return options.list("edges");
    const int bins = static_cast<int>(options.number("bins"));
    if (const double range = options.number("radii_max"); range > 0) return linearEdges(bins, range);
    if (!options.toggle("exact")) return plotEdges(medium, 0, bins);
    return options.given("bins") ? linearEdges(bins, plotEdges(medium, 0, 1).back()) : std::vector<double>{};
}

void refuseWhite(const Options& options) {
    if (options.toggle("exact")) throw usageError("--white and --exact exclude each other", "give one of the two");
    if (options.given("estimator"))
        throw usageError("--white and --estimator exclude each other", "give one of the two");
    if (options.number("grid") > 0) throw usageError("--white has no --grid", "its tables are radial");
    if (options.number("beam_radius") > 0) throw usageError("--white has no --beam", "its tables are of a pencil beam");
}

void refuseGl(const Options& options) {
    for (const char* name : {"white", "exact"})
        if (options.toggle(name))
            throw usageError(fmt::format("--backend gl and --{} exclude each other", name), "OpenGL walks by itself");
    if (options.given("estimator") && options.text("estimator") != "analogue")
        throw usageError("--backend gl has no --estimator best", "OpenGL walks by the analogue estimator");
    if (options.given("threads"))
        throw usageError("--backend gl has no --threads", "the device has its own; --threads is for --backend cpu");
}

// Where the channels came from: null for those that were walked. Channels that share a table share its errors.
Json whiteJson(const ReferenceRun& run) {
    Json tables = Json::array();
    for (int c = 0; c < run.medium.channels; ++c) {
        const auto& used = run.white[static_cast<std::size_t>(c)];
        tables.push_back(used ? Json{{"cache_hit", used->hit},
                                     {"build_seconds", used->table->build_seconds},
                                     {"bytes", used->table->bytes()},
                                     {"file", used->file.string()}}
                              : Json());
    }
    return {{"largest_albedo", kWhiteLargestAlbedo}, {"tables", tables}};
}

// Says why where there is no exact solution.
void refuseExact(const Options& options, const Subject& subject) {
    for (const char* name : {"walks", "estimator"})
        if (options.given(name))
            throw usageError(fmt::format("--exact and --{} exclude each other", name), "give one of the two");
    if (options.number("grid") > 0) throw usageError("--exact has no --grid", "the exact profile is radial");
    if (options.number("beam_radius") > 0)
        throw usageError("--exact has no --beam", "the exact profile is that of a pencil beam");
    for (int c = 0; c < subject.medium.channels; ++c) {
        if (!subject.medium.scatters(c)) continue;
        const HalfSpaceProblem problem = halfSpaceProblem(subject.medium, c, options.number("angle_deg"));
        if (const std::string reason = whyNotExactHalfSpace(problem); !reason.empty())
            throw usageError(
                fmt::format("{} has no exact solution: {}", subject.name, reason),
                "--exact takes normal incidence, |g| up to 0.9, eta 0.5 to 2 and albedo up to 0.99999; without "
                "it the problem is walked");
    }
}

// What the sums depend on, but for the number of walks.
Json problemJson(const Medium& medium, const ReferenceOptions& reference) {
    const auto rgb = [](const Rgb& value) { return Json{value.r, value.g, value.b}; };
    Json json{{"sigma_a", rgb(medium.sigma_a)},
              {"sigma_s", rgb(medium.sigma_s)},
              {"g", rgb(medium.g)},
              {"eta", medium.eta},
              {"channels", medium.channels},
              {"angle_deg", reference.angle_deg},
              {"edges_mm", reference.edges_mm},
              {"grid", reference.grid},
              {"grid_extent_mm", reference.grid_extent_mm},
              {"estimator", reference.estimator == Estimator::best ? "best" : "analogue"}};
    // What came later is named only where it is used, so that older sums go on.
    if (reference.beam.kind != BeamShape::pencil) json["beam"] = {reference.beam.kind, reference.beam.radius};
    if (reference.gl) json["backend"] = "gl";
    return json;
}

std::string estimateText(const Estimate& estimate, bool exact) {
    if (exact) return fmt::format("{:.11f} +- {:.0e}", estimate.mean, estimate.standard_error);
    return fmt::format("{:.6f} +- {:.6f}", estimate.mean, estimate.standard_error);
}

JobResult runReferenceHalfSpace(const Job& job, Engine& engine, Observer& observer) {
    const Options options(job);
    const Subject subject = comparableSubjectOf(job, engine);
    ReferenceOptions reference;
    reference.walks = static_cast<std::uint64_t>(options.number("walks"));
    reference.seed = job.seed;
    reference.angle_deg = options.number("angle_deg");
    reference.edges_mm = edgesOf(options, subject.medium);
    reference.grid = static_cast<int>(options.number("grid"));
    reference.grid_extent_mm = options.number("grid_extent");
    reference.threads = static_cast<int>(options.number("threads"));
    if (options.text("estimator") == "analogue") reference.estimator = Estimator::analogue;
    option::requireGridExtent(options);
    if (options.text("backend") == "gl") {
        refuseGl(options);
        reference.estimator = Estimator::analogue;
        reference.gl = &engine.context();
    }
    reference.beam = beamOf(options);
    reference.white = options.toggle("white");
    if (reference.white) refuseWhite(options);
    reference.exact = options.toggle("exact");
    if (reference.exact) refuseExact(options, subject);
    SavedWalks saved(options, job, problemJson(subject.medium, reference), Rgb::channels, observer);
    if (reference.white || reference.exact)
        for (const char* name : {"resume", "until_error"})
            if (options.given(name))
                throw usageError(fmt::format("--{} is for walks", name), "without --white, --exact");
    reference.control = [&](int channel) { return saved.control(static_cast<std::size_t>(channel)); };
    const ReferenceRun run = runReference(subject.medium, reference, observer);
    JobResult result;
    saved.save(result);
    if (run.interrupted && !std::ranges::any_of(run.channels, [](const auto& c) { return c.has_value(); }))
        throw interruptedError();

    const HalfSpaceResult* any = nullptr;
    Json specular = Json::array();
    std::uint64_t collisions = 0;
    Estimator estimator = Estimator::analogue;
    for (int c = 0; c < run.medium.channels; ++c) {
        const auto& walked = run.channels[static_cast<std::size_t>(c)];
        specular.push_back(walked ? Json(walked->specular) : Json());
        if (!walked) continue;
        any = &*walked;
        collisions += walked->collisions;
        if (walked->estimator == Estimator::best) estimator = Estimator::best;
    }
    if (!any) throw inputError(fmt::format("{} does not scatter in any channel", subject.name));

    Json document = documentJson("searchlight-reference/1", job);
    document["per"] = "incident";
    document["geometry"] = "halfspace";
    document["material"] = subjectJson(subject);
    document["angle_deg"] = run.angle_deg;
    document["beam"] = {{"shape", nameOf(reference.beam.kind)}, {"radius_mm", reference.beam.radius}};
    document["unit"] = "1/mm^2";
    document["specular"] = specular;
    const Json all = tallyJson(run, &HalfSpaceResult::all, reference.grid, reference.grid_extent_mm);
    for (const auto& [key, value] : all.items()) document[key] = value;
    document["single"] = tallyJson(run, &HalfSpaceResult::single, reference.grid, reference.grid_extent_mm);
    document["multiple"] = tallyJson(run, &HalfSpaceResult::multiple, reference.grid, reference.grid_extent_mm);
    document["walks"] = any->walks;
    if (run.interrupted) document["interrupted"] = true;
    document["collisions"] = collisions;
    document["seconds"] = run.seconds();
    document["threads"] = any->threads;
    document["instruction_set"] = any->instruction_set;
    document["backend"] = options.text("backend");
    if (reference.white) document["white"] = whiteJson(run);
    document["estimator"] = reference.exact                ? "exact"
                            : reference.white              ? "white"
                            : estimator == Estimator::best ? "best"
                                                           : "analogue";

    result.json = jsonText(document);
    const std::string method =
        reference.exact ? "exact" : fmt::format("{:.3g} walks per channel", static_cast<double>(any->walks));
    result.text = fmt::format("{}, {}, {} deg, per unit incident flux\n{:<4} {:>9}  {:>22}  {:>22}  {:>22}\n",
                              subject.name, method, run.angle_deg, "", "specular", "diffuse", "single", "multiple");
    for (int c = 0; c < run.medium.channels; ++c) {
        const auto& walked = run.channels[static_cast<std::size_t>(c)];
        if (!walked) {
            result.text +=
                fmt::format("{:<4} {}\n", channelName(run.medium, c),
                            run.medium.scatters(c) ? "not reached" : "not applicable: this channel does not scatter");
            continue;
        }
        result.text += fmt::format("{:<4} {:>9.6f}  {:>22}  {:>22}  {:>22}\n", channelName(run.medium, c),
                                   walked->specular, estimateText(walked->all.total, reference.exact),
                                   estimateText(walked->single.total, reference.exact),
                                   estimateText(walked->multiple.total, reference.exact));
    }
    if (reference.exact)
        result.text +=
            fmt::format("{:.3g} s; +- bounds the numerical error; the profile is in --json\n", run.seconds());
    else if (reference.white)
        result.text +=
            fmt::format("{:.3g} s, from tables of walks without absorption; the profile is in --json\n", run.seconds());
    else
        result.text += fmt::format(
            "{:.3g} walks/s on {}, {:.3g} s; the profile is in --json\n",
            static_cast<double>(run.walks()) / run.seconds(),
            reference.gl ? any->instruction_set : fmt::format("{} threads ({})", any->threads, any->instruction_set),
            run.seconds());
    result.interrupted = run.interrupted;
    if (run.interrupted) result.text += "interrupted\n";
    writeDocument(result, job);
    return result;
}

}  // namespace

Command referenceHalfSpaceCommand() {
    return {.name = "reference halfspace",
            .summary = "Walk the searchlight problem by unbiased Monte Carlo",
            .example = "searchlight reference halfspace --material skin1 --walks 1e6 --radii-max 10 --bins 100 --json",
            .options =
                {option::walks(1e6),
                 option::edges(),
                 option::radiiMax(),
                 option::bins(100),
                 option::angle(),
                 option::beam(),
                 option::beamRadius(),
                 option::grid("R(x, y)"),
                 option::gridExtent(),
                 {.name = "estimator",
                  .type = ParamType::choice,
                  .value = std::string("best"),
                  .choices = {"analogue", "best"},
                  .doc = "analogue: nothing carries a weight; best: far less noise in the same time, analogue only for "
                         "--grid and --beam"},
                 {.name = "white",
                  .type = ParamType::toggle,
                  .value = false,
                  .doc = "from a table of walks without absorption, kept on disk: a new sigma_a or sigma_s, up to "
                         "albedo 0.9999, walks nothing"},
                 {.name = "exact",
                  .type = ParamType::toggle,
                  .value = false,
                  .doc = "solve without walks: normal incidence, |g| up to 0.9, eta 0.5 to 2; stderr then bounds the "
                         "numerical error"},
                 option::walkBackend(),
                 option::threads(),
                 option::untilError("total and profile"),
                 option::resume()},
            .uses_material = true,
            .uses_seed = true,
            .shares_walks = true,
            .output = "the JSON document",
            .run = runReferenceHalfSpace};
}

}  // namespace searchlight
