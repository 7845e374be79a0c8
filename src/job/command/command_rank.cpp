// rank: which model is nearest to the reference on a material, or on all of them.
#include <fmt/format.h>

#include "base/error.h"
#include "base/files.h"
#include "base/version.h"
#include "job/command_table.h"
#include "job/rank/ranking_page.h"
#include "job/shared_options.h"
#include "job/unit_progress.h"
#include "scene/materials.h"

namespace searchlight {

namespace {

constexpr std::string_view every_material = "all";

// One material may take a minute, all of them no longer.
constexpr double collisions_of_one = 4e9, collisions_of_all = 7e7;

std::vector<Subject> subjectsOf(const Job& job, Engine& engine, Observer& observer) {
    if (job.scene.material.id != every_material) return {comparableSubjectOf(job, engine)};
    std::vector<Subject> subjects;
    int skipped = 0;
    for (const Material& material : materials()) {
        if (!material.unit_known) {
            ++skipped;
            continue;
        }
        Job one = job;
        one.scene.material.id = material.id;
        subjects.push_back(comparableSubjectOf(one, engine));
    }
    if (skipped > 0)
        observer.log(LogLevel::info, fmt::format("{} materials whose table states no unit are left out", skipped));
    return subjects;
}

RankEffort effortOf(const Job& job, const Options& options) {
    const bool all = job.scene.material.id == every_material;
    RankEffort effort{.noise = options.number("noise") / 100,
                      .shift_noise = 2 * options.number("noise") / 100,
                      .collisions = options.number("collisions"),
                      .bins = static_cast<int>(options.number("bins")),
                      .angle_deg = options.number("angle_deg"),
                      .seed = job.seed,
                      .threads = static_cast<int>(options.number("threads"))};
    if (effort.collisions == 0) effort.collisions = all ? collisions_of_all : collisions_of_one;
    return effort;
}

JobResult runRank(const Job& job, Engine& engine, Observer& observer) {
    const Options options(job);
    if (!job.output.empty() && !job.output.ends_with(".html"))
        throw usageError(fmt::format("'{}' is no page", job.output), "-o takes a file that ends in .html");
    const RankEffort effort = effortOf(job, options);
    const bool all = job.scene.material.id == every_material;
    std::vector<RankEntry> entries = rankEntries(options.names("models"), all, options.text("backend"), engine);
    const std::vector<Subject> subjects = subjectsOf(job, engine, observer);

    JobResult result;
    std::vector<Ranking> rankings;
    UnitProgress materials(observer, "materials", subjects.size());
    Observer& inner = all ? materials : observer;
    for (const Subject& subject : subjects) {
        try {
            rankings.push_back(rankOn(subject, entries, effort, inner));
        } catch (const Error& error) {
            // What is finished of a table is worth showing.
            if (error.kind != ErrorKind::interrupted || rankings.empty()) throw;
            result.interrupted = true;
            break;
        }
        if (all) materials.finish();
    }

    Json document = documentJson("searchlight-rank/1", job);
    Report report;
    if (all) {
        document["materials"] = matrixJson(rankings, entries);
        result.text = matrixText(rankings, entries);
        if (result.interrupted) {
            document["interrupted"] = true;
            result.text += fmt::format("interrupted after {} of {} materials\n", rankings.size(), subjects.size());
        }
        report = matrixReport(rankings, entries);
    } else {
        document.update(rankingJson(rankings.front(), entries));
        result.text = rankingText(rankings.front(), entries);
        if (!job.output.empty()) report = rankingReport(rankings.front(), entries);
    }
    if (options.text("models") == "all") {
        document["left_out"] = Json::array();
        for (const Model& model : shippedModels()) {
            const std::string reason = whyNotRanked(model, all);
            if (reason.empty()) continue;
            document["left_out"].push_back({{"id", model.id}, {"why", reason}});
            result.text += fmt::format("{} is left out: {}.\n", model.id, reason);
        }
    }
    if (!job.output.empty() && !result.interrupted) {
        report.metadata = {{"program", fmt::format("Searchlight {}", version())}, {"job", jobJson(job)}};
        writeFile(job.output, reportHtml(report));
        document["page"] = job.output;
        observer.log(LogLevel::info, fmt::format("wrote {}", job.output));
    }
    result.json = jsonText(document);
    return result;
}

}  // namespace

Command rankCommand() {
    Param angle = option::angle();
    angle.min = 1;
    angle.value = 45.0;
    angle.doc = "of the beam whose shift is compared";
    return {.name = "rank",
            .summary = "Put models in order of their error on a material, or on all: --material all",
            .example = "searchlight rank --material white_grapefruit_juice -o rank.html",
            .options = {option::models(),
                        {.name = "noise",
                         .unit = "%",
                         .min = 0.01,
                         .max = 50,
                         .value = 0.5,
                         .doc = "of the reference's R_d that is good enough; twice that of its shift"},
                        {.name = "collisions",
                         .min = 0,
                         .max = 1e15,
                         .value = 0.0,
                         .doc = "of the reference per channel at most, noise or not; 0: 4e9, or 7e7 for all materials"},
                        angle,
                        option::bins(48),
                        option::backend(),
                        option::threads()},
            .uses_material = true,
            .uses_seed = true,
            .output = "page: .html",
            .run = runRank};
}

}  // namespace searchlight
