// paper: the figures of a paper, beside their data and what the paper states about them.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "base/error.h"
#include "base/files.h"
#include "base/text.h"
#include "base/version.h"
#include "draw/draw.h"
#include "job/command_table.h"
#include "job/paper/paper.h"
#include "job/plot/figure_result.h"
#include "job/shared_options.h"

namespace searchlight {

namespace {

namespace fs = std::filesystem;

const Paper& findPaper(const std::string& id) {
    std::vector<std::string> names;
    for (const Paper& paper : papers()) {
        if (paper.id == id) return paper;
        names.push_back(paper.id);
    }
    throw unknownName(ErrorKind::usage, "paper", id, names);
}

// One of a paper's figures or tables.
struct Plate {
    const PaperFigure* figure = nullptr;
    const char* kind = "figure";
    const char* stem = "fig";
};

void addPlates(const Paper& paper, const std::vector<PaperFigure>& figures, const std::vector<std::string>& asked,
               Plate plate, std::vector<Plate>& plates) {
    std::vector<std::string> names;
    for (const PaperFigure& figure : figures) names.push_back(figure.id);
    for (const std::string& id : asked == std::vector<std::string>{"all"} ? names : asked) {
        const auto figure = std::ranges::find(figures, id, &PaperFigure::id);
        if (figure == figures.end())
            throw unknownName(ErrorKind::usage, fmt::format("{} of {}", plate.kind, paper.id), id, names);
        plate.figure = &*figure;
        plates.push_back(plate);
    }
}

// Where only figures or only tables are asked for, the others are not made.
std::vector<Plate> platesOf(const Paper& paper, const Options& options) {
    std::vector<Plate> plates;
    if (options.given("figure") || !options.given("table"))
        addPlates(paper, paper.figures, options.names("figure"), {}, plates);
    if (options.given("table") || !options.given("figure"))
        addPlates(paper, paper.tables, options.names("table"), {.kind = "table", .stem = "tab"}, plates);
    return plates;
}

std::string plateText(const Paper& paper, const Plate& which, const PaperPlate& plate) {
    std::string text =
        fmt::format("{}, {} {}: {}\n{}\n", paper.id, which.kind, which.figure->id, which.figure->shows, paper.citation);
    if (!plate.choices.empty()) text += "\nChosen here, where the text leaves it open:\n";
    for (const std::string& choice : plate.choices) text += fmt::format("- {}\n", choice);
    if (!plate.table.empty()) text += "\n" + plate.table;
    for (const PaperStatement& statement : plate.statements)
        text += fmt::format("\nThe paper: {}\nHere: {}\n{}.\n", statement.says, statement.found,
                            statement.holds ? "It holds" : "It does not hold here");
    return text;
}

Json plateJson(const Paper& paper, const Plate& which, const PaperPlate& plate) {
    Json json{{"paper", paper.id},
              {which.kind, which.figure->id},
              {"shows", which.figure->shows},
              {"choices", plate.choices}};
    json["statements"] = Json::array();
    for (const PaperStatement& statement : plate.statements)
        json["statements"].push_back(
            {{"says", statement.says}, {"found", statement.found}, {"holds", statement.holds}});
    json["values"] = plate.values;
    return json;
}

// Draws pictures, or a figure, or a figure and beside it "_pictures". Returns the files' names: there are no sheets of
// pictures in a .pdf.
std::vector<std::string> drawPlate(const PaperPlate& plate, const std::string& stem, const std::string& ending) {
    std::vector<std::string> files;
    const bool has_figure = !plate.sheet || !plate.figure.series.empty() || !plate.figure.panels.empty();
    if (has_figure) {
        files.push_back(stem + ending);
        drawFigure(plate.figure, files.back());
    }
    if (plate.sheet) {
        const std::vector<std::string> formats = sheetFormats();
        const bool has = std::ranges::find(formats, ending) != formats.end();
        files.push_back(stem + (has_figure ? "_pictures" : "") + (has ? ending : ".svg"));
        drawSheet(*plate.sheet, files.back());
    }
    const std::string csv = plate.csv.empty() ? figureCsv(plate.figure) : plate.csv;
    files.push_back(stem + ".csv");
    writeFile(files.back(), csv);
    return files;
}

JobResult runPaper(const Job& job, Engine& engine, Observer& observer) {
    const Options options(job);
    const Paper& paper = findPaper(options.text("paper"));
    const std::vector<Plate> figures = platesOf(paper, options);
    const std::string ending = "." + options.text("format");
    const std::vector<std::string> formats = figureFormats();
    if (std::ranges::find(formats, ending) == formats.end())
        throw usageError(fmt::format("this build draws no {}: it was made without Qt", ending), "--format svg");
    const PaperRun run{.engine = engine,
                       .observer = observer,
                       .walks = static_cast<std::uint64_t>(options.number("reference_walks")),
                       .seed = job.seed,
                       .threads = static_cast<int>(options.number("threads")),
                       .backend = options.text("backend"),
                       .object = options.text("object"),
                       .environment = options.text("environment"),
                       .size = static_cast<int>(options.number("picture_size"))};
    std::vector<PaperPlate> plates;
    for (const Plate& which : figures) {
        plates.push_back(which.figure->make(run));
        PaperPlate& plate = plates.back();
        plate.figure.metadata = {{"program", fmt::format("Searchlight {}", version())}, {"job", jobJson(job)}};
        if (plate.sheet) plate.sheet->metadata = plate.figure.metadata;
    }

    JobResult result;
    Json document = documentJson("searchlight-paper/1", job);
    document["citation"] = paper.citation;
    document["figures"] = Json::array();
    const fs::path folder = job.output;
    if (!folder.empty()) makeFolder(folder);
    for (std::size_t i = 0; i < figures.size(); ++i) {
        const std::string text = plateText(paper, figures[i], plates[i]);
        Json json = plateJson(paper, figures[i], plates[i]);
        result.text += (i > 0 ? "\n" : "") + text;
        if (!folder.empty()) {
            const std::string stem =
                (folder / fmt::format("{}_{}{}", paper.id, figures[i].stem, figures[i].figure->id)).string();
            std::vector<std::string> files = drawPlate(plates[i], stem, ending);
            writeFile(stem + ".txt", text);
            Json whole = documentJson("searchlight-paper/1", job);
            for (const auto& [key, value] : json.items()) whole[key] = value;
            writeFile(stem + ".json", jsonText(whole) + "\n");
            observer.log(LogLevel::info, fmt::format("wrote {}", files.front()));
            for (const char* kind : {".txt", ".json"}) files.push_back(stem + kind);
            json["files"] = files;
        }
        document["figures"].push_back(std::move(json));
    }
    result.json = jsonText(document);
    return result;
}

}  // namespace

Command paperCommand() {
    return {.name = "paper",
            .summary = "Make a paper's figures again, with the reference and what the paper states",
            .example = "searchlight paper frisvad2014 --figure 5 -o out",
            .options = {{.name = "paper",
                         .type = ParamType::text,
                         .value = std::string(),
                         .doc = "mertens2003, chang2007, frisvad2014 or freude2014",
                         .required = true},
                        {.name = "figure",
                         .type = ParamType::text,
                         .value = std::string("all"),
                         .doc = "its numbers, separated by commas, or all; with --table alone, none"},
                        {.name = "table",
                         .type = ParamType::text,
                         .value = std::string("all"),
                         .doc = "the same of its tables; with --figure alone, none"},
                        option::walks(4e6, "reference_walks", "random walks of the reference per curve or picture"),
                        {.name = "format",
                         .type = ParamType::choice,
                         .value = std::string("svg"),
                         .choices = {"svg", "png", "pdf"},
                         .doc = "of the figures"},
                        {.name = "object",
                         .type = ParamType::text,
                         .value = std::string("statue"),
                         .doc = "a closed mesh, or a built-in object, where the paper shows a scan"},
                        {.name = "environment",
                         .type = ParamType::text,
                         .value = std::string(),
                         .doc = "a picture of all directions, where the paper has one; empty: two discs of light"},
                        {.name = "picture_size",
                         .type = ParamType::integer,
                         .unit = "px",
                         .min = 0,
                         .max = 2048,
                         .value = 0.0,
                         .doc = "side of each rendered picture; 0: the figure's own, for a minute or two"},
                        option::backend(),
                        option::threads()},
            .positional = "paper",
            .uses_seed = true,
            .writes_folder = true,
            .output = "the folder of the figures, their data (.csv) and findings (.txt, .json)",
            .run = runPaper};
}

}  // namespace searchlight
