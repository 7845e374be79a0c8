// reference halfspace: the searchlight problem by Monte Carlo.
#include <fmt/format.h>

#include "base/error.h"
#include "base/files.h"
#include "base/text.h"
#include "job/command_table.h"
#include "job/curves.h"
#include "job/json.h"

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

std::vector<double> edgesOf(const Options& options) {
    if (options.given("edges")) {
        if (options.given("bins") || options.given("radii_max"))
            throw usageError("--edges and --bins with --radii-max exclude each other", "give one of the two");
        return options.list("edges");
    }
    if (!options.given("bins") && !options.given("radii_max")) return {};
    if (!options.given("radii_max")) throw usageError("--bins needs --radii-max", "in mm, such as --radii-max 10");
    const int bins = static_cast<int>(options.number("bins"));
    std::vector<double> edges;
    for (int i = 0; i <= bins; ++i) edges.push_back(options.number("radii_max") * i / bins);
    return edges;
}

std::string estimateText(const Estimate& estimate) {
    return fmt::format("{:.6f} +- {:.6f}", estimate.mean, estimate.standard_error);
}

}  // namespace

JobResult runReferenceHalfSpace(const Job& job, Engine& engine, Observer& observer) {
    const Options options(job);
    const Subject subject = comparableSubjectOf(job, engine);
    ReferenceOptions reference;
    reference.walks = static_cast<std::uint64_t>(options.number("walks"));
    reference.seed = job.seed;
    reference.angle_deg = options.number("angle_deg");
    reference.edges_mm = edgesOf(options);
    reference.grid = static_cast<int>(options.number("grid"));
    reference.grid_extent_mm = options.number("grid_extent");
    reference.threads = static_cast<int>(options.number("threads"));
    if (reference.grid > 0 && reference.grid_extent_mm <= 0)
        throw usageError("--grid needs --grid-extent", "half the side of the square, in mm");
    const ReferenceRun run = runReference(subject.medium, reference, observer);

    const HalfSpaceResult* any = nullptr;
    Json specular = Json::array();
    std::uint64_t collisions = 0;
    for (int c = 0; c < run.medium.channels; ++c) {
        const auto& walked = run.channels[static_cast<std::size_t>(c)];
        specular.push_back(walked ? Json(walked->specular) : Json());
        if (!walked) continue;
        any = &*walked;
        collisions += walked->collisions;
    }
    if (!any) throw inputError(fmt::format("{} does not scatter in any channel", subject.name));

    Json document = documentJson("searchlight-reference/1", job);
    document["per"] = "incident";
    document["geometry"] = "halfspace";
    document["material"] = subjectJson(subject);
    document["angle_deg"] = run.angle_deg;
    document["unit"] = "1/mm^2";
    document["specular"] = specular;
    const Json all = tallyJson(run, &HalfSpaceResult::all, reference.grid, reference.grid_extent_mm);
    for (const auto& [key, value] : all.items()) document[key] = value;
    document["single"] = tallyJson(run, &HalfSpaceResult::single, reference.grid, reference.grid_extent_mm);
    document["multiple"] = tallyJson(run, &HalfSpaceResult::multiple, reference.grid, reference.grid_extent_mm);
    document["walks"] = any->walks;
    document["collisions"] = collisions;
    document["seconds"] = run.seconds();
    document["threads"] = any->threads;
    document["instruction_set"] = any->instruction_set;
    document["estimator"] = "analogue";

    JobResult result;
    result.json = document.dump(1);
    result.text = fmt::format(
        "{}, {:.3g} walks per channel, {} deg, per unit incident flux\n{:<4} {:>9}  {:>22}  {:>22}  {:>22}\n",
        subject.name, static_cast<double>(any->walks), run.angle_deg, "", "specular", "diffuse", "single", "multiple");
    for (int c = 0; c < run.medium.channels; ++c) {
        const auto& walked = run.channels[static_cast<std::size_t>(c)];
        if (!walked) {
            result.text +=
                fmt::format("{:<4} not applicable: this channel does not scatter\n", channelName(run.medium, c));
            continue;
        }
        result.text += fmt::format("{:<4} {:>9.6f}  {:>22}  {:>22}  {:>22}\n", channelName(run.medium, c),
                                   walked->specular, estimateText(walked->all.total),
                                   estimateText(walked->single.total), estimateText(walked->multiple.total));
    }
    result.text += fmt::format("{:.3g} walks/s on {} threads ({}), {:.3g} s; the profile is in --json\n",
                               static_cast<double>(run.walks()) / run.seconds(), any->threads, any->instruction_set,
                               run.seconds());
    if (!job.output.empty()) writeFile(job.output, result.json + "\n");
    return result;
}

}  // namespace searchlight
