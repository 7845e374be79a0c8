// contest: one scene by every technique at several budgets, and which of them is nearest at equal time.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "base/error.h"
#include "base/files.h"
#include "base/text.h"
#include "base/version.h"
#include "draw/draw.h"
#include "geometry/object.h"
#include "job/command_table.h"
#include "job/contest/contest_page.h"
#include "job/json.h"
#include "job/render/render_material.h"
#include "job/shared_options.h"
#include "render/view.h"

namespace searchlight {

namespace {

namespace fs = std::filesystem;

// Where nothing is known of a picture: about what one takes.
constexpr double usual_seconds = 2;

// Seconds of a cell after those that its contestant has drawn: by how the last two grew, else as its budget does.
double expectedSeconds(const Contestant& contestant, const std::vector<CellRun>& runs, std::size_t cell) {
    if (runs.empty()) return usual_seconds;
    const double last = runs.back().wall_ms, steps = static_cast<double>(cell - runs.size() + 1);
    double growth = 2;
    if (runs.size() > 1)
        growth = std::max(1.0, last / runs[runs.size() - 2].wall_ms);
    else if (contestant.cells.size() > 1)
        growth = std::max(growth, contestant.cells[1].budget / contestant.cells[0].budget);
    // Short ones are drawn for half a second; of long ones there are two frames.
    return std::max(0.5, 2e-3 * last * std::pow(growth, steps));
}

double secondsLeft(const ContestPlan& plan, const std::vector<std::vector<CellRun>>& runs, double limit) {
    double left = 0;
    for (std::size_t k = 0; k < plan.contestants.size(); ++k)
        for (std::size_t i = runs[k].size(); i < plan.contestants[k].cells.size(); ++i)
            left += std::min(limit, expectedSeconds(plan.contestants[k], runs[k], i));
    return left;
}

ReferenceAims aimsOf(const Job& job, const Options& options) {
    return {.noise = options.number("noise") / 100,
            .most_passes = static_cast<int>(options.number("reference_spp")),
            .walks = options.number("walks"),
            .seed = job.seed,
            .threads = static_cast<int>(options.number("threads")),
            .resume = options.toggle("resume")};
}

// A contest that was interrupted says how to go on.
[[noreturn]] void rethrowInterrupted(const Error& error, std::size_t done, std::size_t total, bool named) {
    if (error.kind != ErrorKind::interrupted) throw error;
    throw Error(error.kind, fmt::format("interrupted with {} of {} pictures done", done, total),
                named ? "with --resume the same command goes on from there" : "");
}

struct Drawn {
    std::vector<std::vector<CellRun>> runs;
    std::vector<std::string> not_drawn;
    std::size_t rendered = 0, found = 0;
};

Drawn drawCells(const ContestPlan& plan, const Options& options, const fs::path& folder, double later_seconds,
                Engine& engine, ContestProgress& progress) {
    Drawn drawn;
    drawn.runs.resize(plan.contestants.size());
    const double limit = options.number("cell_seconds");
    std::size_t total = 0;
    for (const Contestant& contestant : plan.contestants) total += contestant.cells.size();
    for (std::size_t k = 0; k < plan.contestants.size(); ++k) {
        const Contestant& contestant = plan.contestants[k];
        std::unique_ptr<ContestRenderer> renderer;
        for (std::size_t i = 0; i < contestant.cells.size(); ++i) {
            const ContestCell& cell = contestant.cells[i];
            progress.expect(secondsLeft(plan, drawn.runs, limit) + later_seconds);
            if (options.toggle("resume"))
                if (std::optional<CellRun> kept = readCell(folder, cell)) {
                    drawn.runs[k].push_back(std::move(*kept));
                    ++drawn.found;
                    continue;
                }
            if (const double expected = expectedSeconds(contestant, drawn.runs[k], i); expected > limit) {
                drawn.not_drawn.push_back(
                    fmt::format("{} with {} and more was not drawn: about {:.0f} s, and "
                                "--cell-seconds allows {:.0f}.",
                                contestant.label, cell.budget_text, expected, limit));
                break;
            }
            try {
                if (!renderer) renderer = std::make_unique<ContestRenderer>(contestant, engine);
                drawn.runs[k].push_back(renderer->render(cell, progress));
            } catch (const Error& error) {
                rethrowInterrupted(error, drawn.rendered + drawn.found, total, true);
            }
            writeCell(folder, cell, drawn.runs[k].back());
            ++drawn.rendered;
        }
    }
    return drawn;
}

std::string titleOf(const ContestPlan& plan, const Subject& subject) {
    return fmt::format("{} of {} mm in {}, {}", fs::path(plan.scene.object).stem().string(),
                       prettyNumber(plan.scene.scale), subject.name, plan.scene.model.id);
}

JobResult runContest(const Job& job, Engine& engine, Observer& observer) {
    const Options options(job);
    const fs::path folder = job.output.empty() ? fs::path("contest") : fs::path(job.output);
    Subject subject;
    const RenderMaterial material = materialSource(engine, "auto", &subject)(job.scene);
    const ContestPlan plan = contestPlan(job, isRadial(material.model));
    const Object object = placeObject(plan.scene);
    if (!object.isMesh())
        throw usageError(fmt::format("{} is a point cloud", object.name), "direct, which judges, needs a mesh");
    const ReferenceAims aims = aimsOf(job, options);

    makeFolder(folder);
    ContestProgress progress(observer);
    // The references take about as long as direct's dearest picture, times what its noise asks for.
    const double reference_seconds = 8 * usual_seconds;
    const Drawn drawn = drawCells(plan, options, folder, 2 * reference_seconds, engine, progress);
    if (drawn.rendered + drawn.found == 0)
        throw usageError(fmt::format("no picture would be drawn within --cell-seconds {}",
                                     prettyNumber(options.number("cell_seconds"))),
                         "allow more seconds, or smaller budgets");
    ReferencePicture direct, walked;
    try {
        progress.expect(2 * reference_seconds);
        direct = directReference(plan, aims, folder, engine, progress);
        progress.expect(direct.seconds);
        const Camera camera = framedCamera(plan.scene.camera, object, plan.width, plan.height);
        walked = walkedReference(plan, aims, camera, folder, engine, progress);
    } catch (const Error& error) {
        rethrowInterrupted(error, drawn.rendered + drawn.found, drawn.rendered + drawn.found, true);
    }

    ContestResult contest{.plan = &plan, .runs = &drawn.runs, .direct = &direct, .walked = &walked};
    contest.cpu_time = options.text("time") == "cpu";
    contest.score = scoreContest(drawn.runs, direct, walked, aims.threads);
    contest.standings = standingsOf(plan, drawn.runs, contest.score, direct, contest.cpu_time);
    contest.title = titleOf(plan, subject);
    contest.sentence = winnersText(plan, contest.standings, contest.score, direct, walked);
    contest.not_drawn = drawn.not_drawn;

    std::vector<Figure> figures = contestFigures(contest);
    const ContactSheet sheet = contestSheet(contest);
    Report report = contestReport(contest, figures, sheet);
    report.metadata = {{"program", fmt::format("Searchlight {}", version())}, {"job", jobJson(job)}};
    Json document = documentJson("searchlight-contest/1", job);
    document["material"] = subjectJson(subject);
    document.update(contestJson(contest));
    document["rendered"] = drawn.rendered;
    document["found"] = drawn.found;
    document["page"] = (folder / "index.html").string();

    constexpr std::string_view stems[] = {"error_over_time", "model_error_over_time"};
    for (std::size_t i = 0; i < figures.size(); ++i) {
        figures[i].metadata = report.metadata;
        for (const std::string& format : figureFormats())
            drawFigure(figures[i], folder / fmt::format("{}{}", stems[i], format));
    }
    drawSheet(sheet, folder / ("sheet" + sheetFormats().front()));
    writeFile(folder / "contest.csv", contestCsv(contest));
    JobResult result;
    result.json = jsonText(document);
    writeFile(folder / "contest.json", result.json + "\n");
    writeFile(folder / "index.html", reportHtml(report));
    result.text = contestText(contest) + fmt::format("\nwrote {}\n", (folder / "index.html").string());
    return result;
}

}  // namespace

Command contestCommand() {
    std::vector<Param> options{
        {.name = "techniques",
         .type = ParamType::text,
         .value = std::string("all"),
         .doc = "which take part: all, or ids with options such as direct:sampling=area"},
        {.name = "budgets",
         .type = ParamType::text,
         .value = std::string("auto"),
         .doc = "auto, how many of each technique's from the cheapest on, or such as direct=16:64:256"},
        {.name = "backend",
         .type = ParamType::text,
         .value = std::string("cpu"),
         .doc = "cpu, gl or cpu,gl: those that have a version there"},
        {.name = "time",
         .type = ParamType::choice,
         .value = std::string("wall"),
         .choices = {"wall", "cpu"},
         .doc = "what winners and figures go by; tables have both"},
        {.name = "cell_seconds",
         .unit = "s",
         .min = 0,
         .max = option::unlimited,
         .value = 120.0,
         .doc = "pictures that would take longer are not drawn",
         .exclusive = true},
        {.name = "noise",
         .unit = "%",
         .min = 0.001,
         .max = 50,
         .value = 0.5,
         .doc = "of the judge, direct, that is low enough"},
        {.name = "reference_spp",
         .type = ParamType::integer,
         .min = 256,
         .max = 1e6,
         .value = 4096.0,
         .doc = "passes of the judge at most"},
        option::walks(4e6, "walks", "of the path-traced reference, per channel; 0: none", 0),
    };
    for (const Param& param : contestPictureOptions()) options.push_back(param);
    options.push_back({.name = "resume",
                       .type = ParamType::toggle,
                       .value = false,
                       .doc = "pictures and references that are in the folder, from the same job, are kept"});
    return {.name = "contest",
            .summary = "Which technique is nearest at equal time: error over time on one scene",
            .example = "searchlight contest examples/contest/statue.json -o contest",
            .options = std::move(options),
            .uses_scene = true,
            .uses_seed = true,
            .writes_folder = true,
            .output = "the folder of pictures, tables and page (default: contest)",
            .run = runContest};
}

}  // namespace searchlight
