// sweep: pictures of one scene for every combination of materials, models, lights...
#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "base/error.h"
#include "base/files.h"
#include "base/ranks.h"
#include "base/text.h"
#include "draw/contact_sheet.h"
#include "job/command_table.h"
#include "job/json.h"
#include "job/render/kept_renderer.h"
#include "job/sweep/sweep.h"
#include "job/sweep/sweep_result.h"
#include "job/unit_progress.h"

namespace searchlight {

namespace {

namespace fs = std::filesystem;

// Part `index` of `count`: every count-th cell, from that index on.
struct Shard {
    std::size_t index = 0, count = 1;
};

// "2/4", shared out once more among the processes of mpirun.
Shard shardOf(const std::string& text) {
    const std::vector<std::string_view> parts = split(text, '/');
    const auto whole = [&](std::size_t i) {
        const std::optional<double> number = parts.size() == 2 ? parseNumber(parts[i]) : std::nullopt;
        if (!number || *number != std::floor(*number) || *number < 1 || *number > 1e6)
            throw usageError(fmt::format("'{}' is no value for shard", text), "expected i/n with i from 1 to n");
        return static_cast<std::size_t>(*number);
    };
    const std::size_t index = whole(0) - 1, count = whole(1), ranks = static_cast<std::size_t>(rankCount());
    if (index >= count)
        throw usageError(fmt::format("'{}' is no value for shard", text), "expected i/n with i from 1 to n");
    return {index * ranks + static_cast<std::size_t>(rank()), count * ranks};
}

void renderCell(const Sweep& sweep, const SweepCell& cell, const fs::path& folder, Engine& engine, KeptRenderer& kept,
                Observer& observer) {
    Job job = cell.job;
    job.output = cellPath(folder, cell, ".exr").string();
    try {
        const JobResult result = renderPicture(job, engine, kept, observer);
        writeFile(cellPath(folder, cell, ".json"), result.json + "\n");
    } catch (const Error& error) {
        if (error.kind == ErrorKind::interrupted) throw;
        const std::string message = fmt::format("cell {} ({}): {}", cell.number, cellName(sweep, cell), error.message);
        throw Error(error.kind, message, error.hint).at(error.file, error.line, error.column);
    }
}

struct Count {
    std::size_t rendered = 0, found = 0;
};

Count renderCells(const Sweep& sweep, const Shard& shard, const fs::path& folder, Engine& engine, Observer& observer) {
    const std::vector<const SweepCell*> cells = cellsInOrder(sweep, shard.index, shard.count);
    makeFolder(folder);
    std::vector<const SweepCell*> missing;
    for (const SweepCell* cell : cells)
        if (!isDone(folder, *cell)) missing.push_back(cell);
    Count count{.found = cells.size() - missing.size()};
    UnitProgress progress(observer, "cells", missing.size());
    KeptRenderer kept;
    for (const SweepCell* cell : missing) {
        try {
            renderCell(sweep, *cell, folder, engine, kept, progress);
        } catch (const Error& error) {
            if (error.kind != ErrorKind::interrupted) throw;
            throw Error(error.kind,
                        fmt::format("interrupted with {} of {} cells done", count.found + count.rendered, cells.size()),
                        "the same command goes on from there");
        }
        ++count.rendered;
        progress.finish();
    }
    return count;
}

// "1, 2, 3 and 7 more".
std::string missingText(const std::vector<std::size_t>& numbers) {
    constexpr std::size_t most = 8;
    std::vector<std::string> shown;
    for (std::size_t i = 0; i < std::min(most, numbers.size()); ++i) shown.push_back(fmt::format("{}", numbers[i]));
    return join(shown, ", ") + (numbers.size() > most ? fmt::format(" and {} more", numbers.size() - most) : "");
}

JobResult listing(const Sweep& sweep) {
    JobResult result;
    Json cells = Json::array();
    for (const SweepCell& cell : sweep.cells) {
        result.text += fmt::format("{:4}  {}\n", cell.number, cellName(sweep, cell));
        cells.push_back({{"cell", cell.number}, {"job", Json::parse(jobJson(cell.job))}});
    }
    result.json = jsonText(cells);
    return result;
}

JobResult runSweep(const Job& job, Engine& engine, Observer& observer) {
    const Options options(job);
    const fs::path file = options.text("sweep");
    const Sweep sweep = parseSweep(readFile(file), file.string());
    if (options.toggle("list")) return listing(sweep);
    if (const auto number = static_cast<std::size_t>(options.number("cell")); number > 0) {
        if (number > sweep.cells.size())
            throw usageError(fmt::format("there is no cell {}", number), fmt::format("1 to {}", sweep.cells.size()));
        const std::string text = jobJson(sweep.cells[number - 1].job);
        return {.text = text + "\n", .json = text};
    }
    const fs::path folder = job.output.empty() ? file.stem() : fs::path(job.output);
    fs::path sheet = options.text("sheet");
    if (sheet.empty()) sheet = folder / ("sheet" + sheetFormats().front());

    const bool merge_only = options.toggle("merge");
    const Shard shard = shardOf(options.text("shard"));
    Count count;
    if (!merge_only) count = renderCells(sweep, shard, folder, engine, observer);
    // Nobody looks for the cells of others before they are there.
    Count all;
    for (const std::vector<double>& of_rank :
         gatherAll({static_cast<double>(count.rendered), static_cast<double>(count.found)})) {
        all.rendered += static_cast<std::size_t>(of_rank[0]);
        all.found += static_cast<std::size_t>(of_rank[1]);
    }
    if (rank() != 0) return {};

    std::vector<std::size_t> missing;
    for (const SweepCell& cell : sweep.cells)
        if (!isDone(folder, cell)) missing.push_back(cell.number);
    if (merge_only && !missing.empty())
        throw inputError(fmt::format("{} of {} cells are missing in {}: {}", missing.size(), sweep.cells.size(),
                                     folder.string(), missingText(missing)),
                         "without --merge they are rendered");
    JobResult result;
    Json document = documentJson("searchlight-sweep-run/1", job);
    document["cells"] = sweep.cells.size();
    document["rendered"] = all.rendered;
    document["found"] = all.found;
    document["missing"] = missing;
    document["files"] = Json::array();
    result.text = fmt::format("{} cells in {}: {} rendered, {} were there", sweep.cells.size(), folder.string(),
                              all.rendered, all.found);
    result.text += missing.empty() ? "\n" : fmt::format(", {} are missing\n", missing.size());
    if (missing.empty())
        for (const fs::path& path : writeSummary(sweep, folder, sheet)) {
            result.text += path.string() + "\n";
            document["files"].push_back(path.string());
        }
    result.json = jsonText(document);
    return result;
}

}  // namespace

Command sweepCommand() {
    return {.name = "sweep",
            .summary = "Render every combination of materials, models, lights...",
            .example = "searchlight sweep examples/gallery/materials.json -o materials",
            .options = {{.name = "sweep",
                         .type = ParamType::path,
                         .value = std::string(),
                         .doc = "a sweep file (docs/sweep.md)",
                         .required = true},
                        {.name = "shard",
                         .type = ParamType::text,
                         .value = std::string("1/1"),
                         .doc = "only this part of the cells: i/n, every n-th from the i-th on"},
                        {.name = "merge",
                         .type = ParamType::toggle,
                         .value = false,
                         .doc = "render nothing: only the contact sheet and the summary of cells that are there"},
                        {.name = "sheet",
                         .type = ParamType::path,
                         .value = std::string(),
                         .doc = "the contact sheet: .png, .jpg or .svg (default FOLDER/sheet.png)"},
                        {.name = "list",
                         .type = ParamType::toggle,
                         .value = false,
                         .doc = "only say which cells there are; with --json their jobs"},
                        {.name = "cell",
                         .type = ParamType::integer,
                         .min = 0,
                         .max = 10'000,
                         .value = 0.0,
                         .doc = "only print the job of this cell, for `searchlight run`"}},
            .positional = "sweep",
            .writes_in_parts = true,
            .writes_folder = true,
            .output = "the folder of the cells (default: the sweep file's name)",
            .run = runSweep};
}

}  // namespace searchlight
