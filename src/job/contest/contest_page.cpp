#include "job/contest/contest_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "base/text.h"
#include "base/version.h"
#include "draw/palette.h"
#include "io/image_file.h"
#include "plot/error_over_time.h"

namespace searchlight {

namespace {

// Ends of the differences' scale, in percent of the reference's mean.
constexpr double least_shown = 0.1, most_shown = 100;
// Of a picture on the sheet, square px, and its shorter side at least: notes have to fit.
constexpr double sheet_area = 150 * 150;
constexpr double least_side = 90;

std::string_view deviceOf(const Contestant& contestant) { return contestant.gl ? "gl" : "cpu"; }
std::string_view deviceTitle(bool gl) { return gl ? "OpenGL" : "CPU"; }

double timeOf(const ContestResult& result, const CellRun& run) { return result.cpu_time ? run.cpu_ms : run.wall_ms; }

std::string boundedText(const JudgedError& error) {
    return error.resolved ? errorText(error.error) : "< " + errorText(error.upper);
}

std::string signedText(double part) { return fmt::format("{:+.2f} %", 100 * part); }

// Visits every picture that was drawn.
template <class Visit>
void forEachCell(const ContestResult& result, const Visit& visit) {
    for (std::size_t k = 0; k < result.runs->size(); ++k)
        for (std::size_t i = 0; i < (*result.runs)[k].size(); ++i)
            visit(result.plan->contestants[k], result.plan->contestants[k].cells[i], (*result.runs)[k][i],
                  result.score.cells[k][i]);
}

Figure figureAgainst(const ContestResult& result, JudgedError CellScore::*judge, const std::vector<ErrorLevel>& levels,
                     const std::string& title, const std::string& label) {
    std::vector<TimedPanel> panels;
    for (const bool gl : {false, true}) {
        TimedPanel panel{.title = std::string(deviceTitle(gl))};
        for (std::size_t k = 0; k < result.runs->size(); ++k) {
            const Contestant& contestant = result.plan->contestants[k];
            if (contestant.gl != gl) continue;
            TimedErrors technique{.label = contestant.label, .color = contestant.color};
            for (std::size_t i = 0; i < (*result.runs)[k].size(); ++i) {
                const JudgedError& error = result.score.cells[k][i].*judge;
                technique.time_ms.push_back(timeOf(result, (*result.runs)[k][i]));
                technique.error.push_back(error.resolved ? error.error : error.upper);
                // A logarithmic axis has no 0.
                technique.lower.push_back(error.resolved ? error.lower : error.upper);
                technique.upper.push_back(error.upper);
            }
            panel.techniques.push_back(std::move(technique));
        }
        if (!panel.techniques.empty()) panels.push_back(std::move(panel));
    }
    Figure figure = errorOverTimeFigure(panels, levels, title, label);
    figure.caption = fmt::format(
        "{} of a frame under new light, object, points, atlas and visible surface being there. Relative RMSE over the "
        "object's pixels, the reference's noise taken out; bars: two standard errors of what was taken out.",
        result.cpu_time ? "CPU time of all threads" : "Wall time");
    return figure;
}

// What the object takes of a picture, and a little around it.
struct Crop {
    int left = 0, top = 0, width = 0, height = 0;
};

Crop cropOf(const Image& reference) {
    int left = reference.width, top = reference.height, right = 0, bottom = 0;
    for (int y = 0; y < reference.height; ++y)
        for (int x = 0; x < reference.width; ++x) {
            if (reference.at(x, y).a <= 0) continue;
            left = std::min(left, x);
            right = std::max(right, x + 1);
            top = std::min(top, y);
            bottom = std::max(bottom, y + 1);
        }
    const int margin = std::max(1, reference.height / 60);
    left = std::max(0, left - margin);
    top = std::max(0, top - margin);
    return {left, top, std::min(reference.width, right + margin) - left,
            std::min(reference.height, bottom + margin) - top};
}

std::string pictureOf(const Image& image, const Crop& crop, double exposure) {
    Image part(crop.width, crop.height);
    for (int y = 0; y < crop.height; ++y)
        for (int x = 0; x < crop.width; ++x) {
            part.at(x, y) = image.at(crop.left + x, crop.top + y);
            part.at(x, y).a = 1;
        }
    return imageBytes("sheet.png", {std::move(part), {}, {}}, {.exposure = exposure});
}

// The largest difference of R, G, B over the reference's mean, on the scale of colours.
std::string differenceOf(const Image& image, const Image& reference, const Crop& crop) {
    double sum = 0;
    std::size_t count = 0;
    for (const Rgba& p : reference.pixels)
        if (p.a > 0) {
            sum += (static_cast<double>(p.r) + p.g + p.b) / 3;
            ++count;
        }
    const double mean = sum / static_cast<double>(count);
    std::vector<std::uint8_t> indices;
    for (int y = crop.top; y < crop.top + crop.height; ++y)
        for (int x = crop.left; x < crop.left + crop.width; ++x) {
            const Rgba &a = image.at(x, y), &b = reference.at(x, y);
            const double largest = std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)});
            const double percent = std::max(100 * largest / mean, least_shown);
            const double at = std::min(std::log(percent / least_shown) / std::log(most_shown / least_shown), 1.0);
            indices.push_back(b.a > 0 ? static_cast<std::uint8_t>(std::lround(at * (scale_colors - 1)))
                                      : transparent_color);
        }
    return palettePng(crop.width, crop.height, indices);
}

std::string effortText(const ReferencePicture& reference, std::string_view what) {
    return fmt::format("{} {}, {:.1f} s, noise {}", countText(static_cast<double>(reference.effort)), what,
                       reference.seconds, errorText(reference.noise));
}

ReportTable cellTable(const ContestResult& result) {
    const bool walks = !result.walked->empty();
    ReportTable table{
        .caption =
            "Error: relative RMSE, the reference's noise taken out; < where it is not told from that noise. "
            "Mean: of the difference, with its sign. Times of a frame under new light.",
        .header = {"technique", "on", "budget", "wall ms", "CPU ms", "from direct", "mean", "SSIM", "FLIP"}};
    if (walks) table.header.insert(table.header.end(), {"from walks", "mean"});
    forEachCell(result,
                [&](const Contestant& contestant, const ContestCell& cell, const CellRun& run, const CellScore& score) {
                    std::vector<std::string> row{contestant.label,
                                                 std::string(deviceTitle(contestant.gl)),
                                                 cell.budget_text.empty() ? "–" : cell.budget_text,
                                                 prettyNumber(run.wall_ms, 3),
                                                 prettyNumber(run.cpu_ms, 3),
                                                 boundedText(score.direct),
                                                 signedText(score.against_direct.mean_difference),
                                                 fmt::format("{:.4f}", score.against_direct.ssim),
                                                 fmt::format("{:.4f}", score.against_direct.flip)};
                    if (walks) row.insert(row.end(), {boundedText(score.walked), signedText(score.walked_mean)});
                    table.rows.push_back(std::move(row));
                });
    return table;
}

// Columns are the stages that any has.
ReportTable stageTable(const ContestResult& result, std::map<std::string, double> CellRun::*stages, bool first_only,
                       std::string caption) {
    std::set<std::string> names;
    forEachCell(result, [&](const Contestant&, const ContestCell&, const CellRun& run, const CellScore&) {
        for (const auto& [name, ms] : run.*stages) names.insert(name);
    });
    ReportTable table{.caption = std::move(caption), .header = {"technique", "on", "budget"}};
    table.header.insert(table.header.end(), names.begin(), names.end());
    const Contestant* before = nullptr;
    forEachCell(result,
                [&](const Contestant& contestant, const ContestCell& cell, const CellRun& run, const CellScore&) {
                    const bool again = before == &contestant;
                    before = &contestant;
                    if (first_only && again) return;
                    std::vector<std::string> row{contestant.label, std::string(deviceTitle(contestant.gl)),
                                                 cell.budget_text.empty() ? "–" : cell.budget_text};
                    for (const std::string& name : names) {
                        const auto found = (run.*stages).find(name);
                        row.push_back(found == (run.*stages).end() ? "–" : prettyNumber(found->second, 3));
                    }
                    table.rows.push_back(std::move(row));
                });
    return table;
}

ReportSection winnerSection(const ContestResult& result) {
    ReportSection section{.heading = "Who wins where"};
    for (const BackendStandings& each : result.standings) {
        ReportTable times{.caption = fmt::format("Nearest to direct on {}, by the time that there is.",
                                                 each.gl ? "OpenGL" : "the CPU"),
                          .header = {"from", "to", "technique", "error at the end"}};
        for (const TimeReign& reign : each.by_time)
            times.rows.push_back({durationText(reign.from_ms),
                                  std::isfinite(reign.to_ms) ? durationText(reign.to_ms) : "any",
                                  each.labels[reign.curve], errorText(reign.error)});
        ReportTable errors{
            .caption = fmt::format("Fastest on {}, by the error that is allowed.", each.gl ? "OpenGL" : "the CPU"),
            .header = {"from", "down to", "technique", "time at the end"}};
        for (const ErrorReign& reign : each.by_error)
            errors.rows.push_back(
                {errorText(reign.from), errorText(reign.to), each.labels[reign.curve], durationText(reign.ms)});
        section.tables.push_back(std::move(times));
        section.tables.push_back(std::move(errors));
    }
    return section;
}

ReportSection referenceSection(const ContestResult& result) {
    ReportSection section{.heading = "What they are judged by"};
    section.paragraphs.push_back(
        fmt::format("direct: the same model, integrated without bias; {}.", effortText(*result.direct, "passes")));
    if (result.walked->empty())
        section.paragraphs.push_back(fmt::format("There is no path-traced reference: {}.", result.walked->absent));
    else
        section.paragraphs.push_back(
            fmt::format("Path-traced: exitance by walks through the mesh, a mean over cells of four pixels, where the "
                        "object fills the pixel; {}. {} itself, by direct, is {} from it ({} in the mean).",
                        effortText(*result.walked, "walks per channel"), result.plan->scene.model.id,
                        boundedText(result.score.model), signedText(result.score.model_mean)));
    for (const auto& [id, why] : result.plan->left_out)
        section.paragraphs.push_back(fmt::format("{} takes no part: {}.", id, why));
    for (const std::string& text : result.not_drawn) section.paragraphs.push_back(text);
    std::set<std::string> notes;
    forEachCell(result, [&](const Contestant&, const ContestCell&, const CellRun& run, const CellScore&) {
        notes.insert(run.notes.begin(), run.notes.end());
    });
    section.paragraphs.insert(section.paragraphs.end(), notes.begin(), notes.end());
    return section;
}

Json judgedJson(const JudgedError& error) {
    return {{"raw", error.raw},
            {"error", error.error},
            {"lower", error.lower},
            {"upper", error.upper},
            {"resolved", error.resolved}};
}

Json referenceJson(const ReferencePicture& reference, const char* effort) {
    if (reference.empty()) return {{"absent", reference.absent}};
    return {{effort, reference.effort}, {"noise", reference.noise}, {"seconds", reference.seconds}};
}

}  // namespace

std::vector<Figure> contestFigures(const ContestResult& result) {
    std::vector<Figure> figures;
    figures.push_back(figureAgainst(result, &CellScore::direct, {{"noise of direct", result.direct->noise}},
                                    result.title + ": error against direct", "Difference from direct"));
    if (result.walked->empty()) return figures;
    std::vector<ErrorLevel> levels{{"the model's own error", result.score.model.error},
                                   {"noise of the walks", result.walked->noise}};
    figures.push_back(figureAgainst(result, &CellScore::walked, levels,
                                    result.title + ": error against the path-traced reference",
                                    "Difference from walks"));
    return figures;
}

ContactSheet contestSheet(const ContestResult& result) {
    const double exposure = result.score.exposure;
    ContactSheet sheet;
    sheet.title = result.title;
    sheet.caption =
        fmt::format("One exposure for all: {:+.2f} stops. In colours: the difference from direct.", exposure);
    sheet.color =
        Axis{"largest difference of R, G, B over the mean", "%", AxisScale::logarithmic, least_shown, most_shown};
    const Crop crop = cropOf(result.direct->image);
    const double shrink = std::max(std::sqrt(sheet_area / (1.0 * crop.width * crop.height)),
                                   least_side / std::min(crop.width, crop.height));
    sheet.picture_width = static_cast<int>(std::lround(shrink * crop.width));
    sheet.picture_height = static_cast<int>(std::lround(shrink * crop.height));
    sheet.metadata = {{"Software", fmt::format("Searchlight {}", version())}};
    std::size_t columns = 3;
    for (const auto& of_one : *result.runs) columns = std::max(columns, of_one.size());
    for (std::size_t i = 0; i < columns; ++i)
        sheet.columns.push_back(i == 0 ? "cheapest" : i + 1 == columns ? "dearest" : "");
    const auto row = [&](std::string heading) {
        sheet.rows.push_back(std::move(heading));
        sheet.cells.resize(sheet.rows.size() * columns);
        return sheet.cells.end() - static_cast<std::ptrdiff_t>(columns);
    };
    auto reference = row("References");
    reference[0] = {pictureOf(result.direct->image, crop, exposure),
                    "direct, noise " + errorText(result.direct->noise)};
    if (!result.walked->empty()) {
        reference[1] = {pictureOf(result.walked->image, crop, exposure),
                        "walks, noise " + errorText(result.walked->noise)};
        reference[2] = {differenceOf(result.direct->image, result.walked->image, crop),
                        "direct from walks: " + boundedText(result.score.model)};
    }
    for (std::size_t k = 0; k < result.runs->size(); ++k) {
        const Contestant& contestant = result.plan->contestants[k];
        const std::string name = fmt::format("{} on {}", contestant.label, deviceTitle(contestant.gl));
        auto pictures = row(name);
        for (std::size_t i = 0; i < (*result.runs)[k].size(); ++i)
            pictures[static_cast<std::ptrdiff_t>(i)] = {
                pictureOf((*result.runs)[k][i].image, crop, exposure),
                fmt::format("{}{}{}", contestant.cells[i].budget_text,
                            contestant.cells[i].budget_text.empty() ? "" : ", ",
                            durationText(timeOf(result, (*result.runs)[k][i])))};
        auto differences = row("difference");
        for (std::size_t i = 0; i < (*result.runs)[k].size(); ++i)
            differences[static_cast<std::ptrdiff_t>(i)] = {
                differenceOf((*result.runs)[k][i].image, result.direct->image, crop),
                boundedText(result.score.cells[k][i].direct)};
    }
    return sheet;
}

std::string contestCsv(const ContestResult& result) {
    std::string csv = fmt::format("# Searchlight {}\n", version());
    csv +=
        "# ms: of a frame under new light; direct, walked: relative RMSE, the reference's noise taken out, and its "
        "bounds; raw: as measured; noise: of the reference\n";
    csv +=
        "technique,backend,budget,value,wall_ms,cpu_ms,direct,direct_lower,direct_upper,direct_raw,direct_noise,"
        "mean_difference,ssim,flip,walked,walked_lower,walked_upper,walked_raw,walked_noise,walked_mean\n";
    forEachCell(result, [&](const Contestant& contestant, const ContestCell& cell, const CellRun& run,
                            const CellScore& score) {
        const JudgedError &d = score.direct, &w = score.walked;
        csv += fmt::format("\"{}\",{},{},{},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g}",
                           contestant.label, deviceOf(contestant), contestant.entry->budget.option, cell.budget,
                           run.wall_ms, run.cpu_ms, d.error, d.lower, d.upper, d.raw, result.direct->noise,
                           score.against_direct.mean_difference, score.against_direct.ssim, score.against_direct.flip);
        csv += result.walked->empty() ? std::string(",,,,,,\n")
                                      : fmt::format(",{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g}\n", w.error, w.lower,
                                                    w.upper, w.raw, result.walked->noise, score.walked_mean);
    });
    return csv;
}

Json contestJson(const ContestResult& result) {
    Json json;
    json["title"] = result.title;
    json["winners"] = result.sentence;
    json["time"] = result.cpu_time ? "cpu" : "wall";
    json["references"] = {{"direct", referenceJson(*result.direct, "passes")},
                          {"walks", referenceJson(*result.walked, "walks")}};
    json["model"] = Json();
    if (!result.walked->empty()) {
        json["model"] = judgedJson(result.score.model);
        json["model"]["mean_difference"] = result.score.model_mean;
    }
    json["standings"] = Json::array();
    for (const BackendStandings& each : result.standings) {
        Json by_time = Json::array(), by_error = Json::array();
        for (const TimeReign& reign : each.by_time)
            by_time.push_back({{"technique", each.labels[reign.curve]},
                               {"from_ms", reign.from_ms},
                               {"to_ms", std::isfinite(reign.to_ms) ? Json(reign.to_ms) : Json()},
                               {"error", reign.error}});
        for (const ErrorReign& reign : each.by_error)
            by_error.push_back(
                {{"technique", each.labels[reign.curve]}, {"from", reign.from}, {"to", reign.to}, {"ms", reign.ms}});
        json["standings"].push_back(
            {{"backend", each.gl ? "gl" : "cpu"},
             {"nearest_over_time", by_time},
             {"fastest_over_error", by_error},
             {"model_dominates_from_ms", each.model_from_ms > 0 ? Json(each.model_from_ms) : Json()}});
    }
    json["cells"] = Json::array();
    forEachCell(result,
                [&](const Contestant& contestant, const ContestCell& cell, const CellRun& run, const CellScore& score) {
                    Json entry{{"technique", contestant.entry->id},
                               {"label", contestant.label},
                               {"backend", deviceOf(contestant)},
                               {"budget", contestant.entry->budget.option},
                               {"value", cell.budget},
                               {"file", fmt::format("cells/{}.exr", cell.stem)},
                               {"found", run.found},
                               {"wall_ms", run.wall_ms},
                               {"cpu_ms", run.cpu_ms},
                               {"frames", run.frames},
                               {"stage_ms", run.stage_ms},
                               {"shared_ms", run.shared_ms},
                               {"direct", judgedJson(score.direct)}};
                    entry["mean_difference"] = score.against_direct.mean_difference;
                    entry["ssim"] = score.against_direct.ssim;
                    entry["flip"] = score.against_direct.flip;
                    if (!result.walked->empty()) {
                        entry["walked"] = judgedJson(score.walked);
                        entry["walked"]["mean_difference"] = score.walked_mean;
                    }
                    json["cells"].push_back(std::move(entry));
                });
    json["left_out"] = Json::array();
    for (const auto& [id, why] : result.plan->left_out) json["left_out"].push_back({{"id", id}, {"why", why}});
    for (const std::string& text : result.not_drawn) json["not_drawn"].push_back(text);
    return json;
}

std::string contestText(const ContestResult& result) {
    std::string text = fmt::format("{}\n{}\n\n", result.title, result.sentence);
    std::size_t widest = 9;
    for (const Contestant& contestant : result.plan->contestants) widest = std::max(widest, contestant.label.size());
    text += fmt::format("{:<{}} {:<4} {:>14} {:>10} {:>10} {:>12} {:>12}\n", "technique", widest, "on", "budget",
                        "wall ms", "CPU ms", "from direct", "from walks");
    forEachCell(
        result, [&](const Contestant& contestant, const ContestCell& cell, const CellRun& run, const CellScore& score) {
            text += fmt::format("{:<{}} {:<4} {:>14} {:>10.1f} {:>10.1f} {:>12} {:>12}\n", contestant.label, widest,
                                deviceOf(contestant), cell.budget_text, run.wall_ms, run.cpu_ms,
                                boundedText(score.direct), result.walked->empty() ? "-" : boundedText(score.walked));
        });
    text += fmt::format("\ndirect: {}\n", effortText(*result.direct, "passes"));
    text += result.walked->empty() ? fmt::format("no walks: {}\n", result.walked->absent)
                                   : fmt::format("walks: {}\n", effortText(*result.walked, "per channel"));
    for (const auto& [id, why] : result.plan->left_out) text += fmt::format("{} takes no part: {}\n", id, why);
    for (const std::string& line : result.not_drawn) text += line + "\n";
    return text;
}

Report contestReport(const ContestResult& result, const std::vector<Figure>& figures, const ContactSheet& sheet) {
    Report report{.title = "Contest: " + result.title, .summary = result.sentence};
    ReportSection plots{.heading = "Error over time"};
    plots.figures = figures;
    ReportSection pictures{.heading = "Pictures"};
    pictures.sheets.push_back(sheet);
    ReportSection numbers{.heading = "Numbers"};
    numbers.tables.push_back(cellTable(result));
    ReportSection times{.heading = "Where the time goes"};
    times.tables.push_back(
        stageTable(result, &CellRun::stage_ms, false, "Of a frame under new light: wall time of its stages, ms."));
    times.tables.push_back(stageTable(
        result, &CellRun::shared_ms, true,
        "Of the first frame alone, ms: what stays as long as object, material and camera do. Not part of the times "
        "above. Object and rays would be shared by all; here each technique begins from nothing."));
    report.sections = {std::move(plots),   winnerSection(result), std::move(pictures),
                       std::move(numbers), std::move(times),      referenceSection(result)};
    return report;
}

}  // namespace searchlight
