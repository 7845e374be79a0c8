// [Chang2007], Figures 4.5, 4.8 and 4.9: texture space alone, and beside samples around each receiver.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "job/paper/chang2007.h"
#include "job/unit_progress.h"

namespace searchlight {

namespace {

struct Named {
    const char* id;
    const char* title;
};

ParamValues hybridOf(double samples, double local_samples) {
    return {{"samples", samples}, {"local_samples", local_samples}};
}

// What 4.8 and 4.9 share: columns of texture space, hybrid and truth.
struct Column {
    std::string title;
    std::vector<double> counts;  // of texture space, row by row
    PaperPicture truth;
    std::vector<PaperPicture> by_texture;
    PaperPicture by_hybrid;
};

void layOut(PaperPlate& plate, ContactSheet sheet, const std::vector<Column>& columns,
            const std::vector<std::string>& rows) {
    sheet.rows = rows;
    const std::size_t n = columns.size();
    sheet.cells.resize(rows.size() * n);
    for (std::size_t c = 0; c < n; ++c) {
        const Column& column = columns[c];
        sheet.columns.push_back(column.title);
        const double exposure = column.truth.exposure;
        std::vector<SheetCell> cells;
        for (std::size_t k = 0; k < column.by_texture.size(); ++k) {
            const PaperPicture& picture = column.by_texture[k];
            const double error = errorOf(picture, column.truth);
            cells.push_back(shownCell(
                picture.image, exposure,
                fmt::format("{:.0f}: {}, {:.0f} ms", column.counts[k], percentOf(error), picture.sum_cpu_ms)));
            plate.values[column.title]["texture_space"].push_back(
                {{"samples", column.counts[k]}, {"relative_rmse", error}, {"sum_cpu_ms", picture.sum_cpu_ms}});
        }
        const double error = errorOf(column.by_hybrid, column.truth);
        cells.push_back(shownCell(column.by_hybrid.image, exposure,
                                  fmt::format("{}, {:.0f} ms", percentOf(error), column.by_hybrid.sum_cpu_ms)));
        plate.values[column.title]["hybrid"] = {{"relative_rmse", error}, {"sum_cpu_ms", column.by_hybrid.sum_cpu_ms}};
        cells.push_back(differenceCell(column.by_hybrid.image, column.truth.image, 0.05, ""));
        cells.push_back(shownCell(column.truth.image, exposure));
        for (std::size_t r = 0; r < rows.size(); ++r) sheet.cells[r * n + c] = std::move(cells[r]);
    }
    plate.sheet = std::move(sheet);
}

constexpr std::string_view sheet_caption =
    "Below: samples, relative RMSE against the sum over all points, and processor time of the sum, texture space one "
    "by one. Differences end at a twentieth of the mean.";

}  // namespace

ParamValues samplesOf(double count) { return {{"samples", count}}; }

void setSize(PaperStudio& studio, double size_mm) { studio.scene.material.scale = 10 / size_mm; }

void chooseScene(PaperPlate& plate, const PaperRun& run) {
    plate.choices.push_back("in place of the thesis' models, which are not free: " + studioText(run));
    plate.choices.emplace_back(
        "errors are relative RMSE of the picture against the light of 200,000 points, summed to 0.1 %");
}

void chooseSizes(PaperPlate& plate) {
    plate.choices.emplace_back(
        "another size is another scale of the medium: an object of 70 mm has the picture of one of 10 mm in a medium "
        "seven times as dense");
}

PaperPlate chang2007Figure45(const PaperRun& run) {
    PaperPlate plate;
    chooseScene(plate, run);
    chooseSizes(plate);
    plate.choices.emplace_back("the second of the three materials is not readable in the thesis' text: marble");
    plate.choices.emplace_back(
        "hybrid: 900 + 401 samples; time of texture space: that of 1,600 samples one by one, in proportion to their "
        "number");
    constexpr std::array<Named, 3> materials{{{"skim_milk", "Skim milk"}, {"marble", "Marble"}, {"skin2", "Skin2"}}};
    const std::vector<double> sizes{10, 25, 40, 55, 70}, counts{400, 1600, 6400, 25600, 102400};
    constexpr double wanted = 0.05;
    UnitProgress progress(run.observer, "pictures", materials.size() * sizes.size() * (counts.size() + 2) + 1);
    PaperStudio studio(run, progress);
    ContactSheet sheet = paperSheet(studio, "Five sizes with 1,600 samples, Fig. 4.5",
                                    "Texture space alone. Below: relative RMSE against the sum over all points.");
    sheet.column_title = "Size";
    for (const double size : sizes) sheet.columns.push_back(fmt::format("{:.0f} mm", size));
    Figure& figure = plate.figure;
    figure.title = "Texture space and the hybrid over size, Fig. 4.5";
    figure.caption = fmt::format(
        "Solid: texture space, error with 1,600 samples; dashed: hybrid, 900 + 401 samples. Time: of the sum; texture "
        "space one by one, with the "
        "samples that {:.0f} % take.",
        100 * wanted);
    figure.columns = 3;
    const Axis size_axis{.label = "Size", .unit = "mm"};
    figure.panels = {
        {.title = "Error",
         .x = size_axis,
         .y = {.label = "Relative RMSE", .unit = "%", .scale = AxisScale::logarithmic}},
        {.title = "Samples",
         .x = size_axis,
         .y = {.label = fmt::format("Samples for {:.0f} %", 100 * wanted), .scale = AxisScale::logarithmic}},
        {.title = "Time",
         .x = size_axis,
         .y = {.label = "CPU time of the sum", .unit = "ms", .scale = AxisScale::logarithmic}}};
    studio.scene.material.id = materials[0].id;
    const PaperPicture one_by_one = studio.take("texture-space", {{"samples", 1600.0}, {"sum", std::string("loop")}});
    progress.finish();
    std::string errors_found, hybrid_found;
    bool grows = true, holds = true;
    for (std::size_t m = 0; m < materials.size(); ++m) {
        sheet.rows.emplace_back(materials[m].title);
        studio.scene.material.id = materials[m].id;
        const int color = static_cast<int>(m);
        Series error{.label = materials[m].title, .color = color}, samples = error, time = error;
        Series hybrid_error{.label = fmt::format("{}, hybrid", materials[m].title), .color = color, .dashed = true};
        Series hybrid_time = hybrid_error;
        for (const double size : sizes) {
            setSize(studio, size);
            const PaperPicture truth = studio.truth();
            progress.finish();
            std::vector<double> errors;
            for (const double count : counts) {
                const PaperPicture picture = studio.take("texture-space", samplesOf(count));
                errors.push_back(errorOf(picture, truth));
                if (count == 1600)
                    sheet.cells.push_back(shownCell(picture.image, truth.exposure, percentOf(errors.back())));
                progress.finish();
            }
            const PaperPicture hybrid = studio.take("hybrid", hybridOf(900, 401));
            progress.finish();
            const double needed = whereItFallsTo(wanted, counts, errors);
            for (Series* series : {&error, &samples, &time, &hybrid_error, &hybrid_time}) series->x.push_back(size);
            error.y.push_back(100 * errors[1]);
            samples.y.push_back(needed);
            time.y.push_back(one_by_one.sum_cpu_ms * needed / 1600);
            hybrid_error.y.push_back(100 * errorOf(hybrid, truth));
            hybrid_time.y.push_back(hybrid.sum_cpu_ms);
            plate.values[materials[m].id].push_back({{"size_mm", size},
                                                     {"samples", counts},
                                                     {"relative_rmse", errors},
                                                     {"samples_for_5_percent", needed},
                                                     {"hybrid_relative_rmse", hybrid_error.y.back() / 100},
                                                     {"hybrid_sum_cpu_ms", hybrid.sum_cpu_ms}});
        }
        grows = grows && samples.y.back() > 5 * samples.y.front();
        const auto [least, most] = std::ranges::minmax(hybrid_error.y);
        const auto [fastest, slowest] = std::ranges::minmax(hybrid_time.y);
        holds = holds && most < 2 * least && slowest < 1.5 * fastest;
        errors_found += fmt::format("{}{}: {:.2g} to {:.2g} % with 1,600 samples; {:.0f} to {:.0f} samples for 5 %",
                                    errors_found.empty() ? "" : ". ", materials[m].title, error.y.front(),
                                    error.y.back(), samples.y.front(), samples.y.back());
        hybrid_found += fmt::format("{}{}: {:.2g} to {:.2g} %, {:.0f} to {:.0f} ms", hybrid_found.empty() ? "" : ". ",
                                    materials[m].title, least, most, fastest, slowest);
        samples.in_legend = time.in_legend = hybrid_time.in_legend = false;
        figure.panels[0].series.push_back(std::move(error));
        figure.panels[0].series.push_back(std::move(hybrid_error));
        figure.panels[1].series.push_back(std::move(samples));
        figure.panels[2].series.push_back(std::move(time));
        figure.panels[2].series.push_back(std::move(hybrid_time));
    }
    plate.sheet = std::move(sheet);
    plate.statements.push_back(
        {.says = "the larger the object, the more samples texture space takes", .found = errors_found, .holds = grows});
    plate.statements.push_back(
        {.says = "the hybrid renders all sizes with the same number of samples, at the same error and cost",
         .found = "from 10 to 70 mm. " + hybrid_found,
         .holds = holds});
    return plate;
}

PaperPlate chang2007Figure48(const PaperRun& run) {
    PaperPlate plate;
    chooseScene(plate, run);
    chooseSizes(plate);
    plate.choices.emplace_back(
        "skin1, as the figure's caption says; the text says skin2. Of the thesis' numbers of samples 14,400 at 30 mm "
        "is readable");
    const std::array<double, 3> sizes{10, 20, 30};
    UnitProgress progress(run.observer, "pictures", 4 * sizes.size());
    PaperStudio studio(run, progress);
    studio.scene.material.id = "skin1";
    std::vector<Column> columns;
    for (const double size : sizes) {
        setSize(studio, size);
        Column column{.title = fmt::format("{:.0f} mm", size), .counts = {1600, 14400}};
        column.truth = studio.truth();
        progress.finish();
        for (const double count : column.counts) {
            column.by_texture.push_back(
                studio.take("texture-space", {{"samples", count}, {"sum", std::string("loop")}}));
            progress.finish();
        }
        column.by_hybrid = studio.take("hybrid", hybridOf(900, 401));
        progress.finish();
        columns.push_back(std::move(column));
    }
    layOut(plate, paperSheet(studio, "Three sizes of skin, Fig. 4.8", std::string(sheet_caption)), columns,
           {"Texture space", "Texture space", "Hybrid, 900 + 401", "its difference", "Sum over points"});
    const Column &small = columns.front(), &large = columns.back();
    const double few = errorOf(large.by_texture[0], large.truth), many = errorOf(large.by_texture[1], large.truth);
    const double hybrid = errorOf(large.by_hybrid, large.truth), hybrid_small = errorOf(small.by_hybrid, small.truth);
    plate.statements.push_back(
        {.says = "at 30 mm texture space takes 14,400 samples",
         .found = fmt::format("errors at 30 mm: {} with 1,600 samples, {} with 14,400; at 10 mm 1,600 leave {}",
                              percentOf(few), percentOf(many), percentOf(errorOf(small.by_texture[0], small.truth))),
         .holds = many < 0.4 * few});
    plate.statements.push_back(
        {.says = "the hybrid is accurate at all sizes with 900 + 401 samples, at the same 17.26 frames per second",
         .found = fmt::format("errors {} at 10 mm, {} at 30 mm; sums {:.0f} and {:.0f} ms, {:.1f} times less than "
                              "14,400 samples one by one",
                              percentOf(hybrid_small), percentOf(hybrid), small.by_hybrid.sum_cpu_ms,
                              large.by_hybrid.sum_cpu_ms, large.by_texture[1].sum_cpu_ms / large.by_hybrid.sum_cpu_ms),
         .holds = hybrid < std::max(2 * hybrid_small, many) &&
                  large.by_hybrid.sum_cpu_ms < 1.5 * small.by_hybrid.sum_cpu_ms});
    return plate;
}

PaperPlate chang2007Figure49(const PaperRun& run) {
    PaperPlate plate;
    chooseScene(plate, run);
    constexpr std::array<Named, 3> materials{{{"skim_milk", "Skim milk"}, {"marble", "Marble"}, {"cream", "Cream"}}};
    UnitProgress progress(run.observer, "pictures", 3 * materials.size());
    PaperStudio studio(run, progress);
    std::vector<Column> columns;
    double worst = 0;
    std::string found;
    for (const Named& material : materials) {
        studio.scene.material.id = material.id;
        Column column{.title = material.title, .counts = {1600}};
        column.truth = studio.truth();
        progress.finish();
        column.by_texture.push_back(studio.take("texture-space", {{"samples", 1600.0}, {"sum", std::string("loop")}}));
        progress.finish();
        column.by_hybrid = studio.take("hybrid", hybridOf(900, 401));
        progress.finish();
        const double texture = errorOf(column.by_texture[0], column.truth);
        const double hybrid = errorOf(column.by_hybrid, column.truth);
        worst = std::max(worst, hybrid);
        found += fmt::format("{}{}: {} by texture space, {} by the hybrid", found.empty() ? "" : "; ", material.title,
                             percentOf(texture), percentOf(hybrid));
        columns.push_back(std::move(column));
    }
    layOut(plate, paperSheet(studio, "Three materials at 10 mm, Fig. 4.9", std::string(sheet_caption)), columns,
           {"Texture space", "Hybrid, 900 + 401", "its difference", "Sum over points"});
    plate.statements.push_back({.says = "the hybrid's pictures of other materials are those of texture space",
                                .found = found,
                                .holds = worst < 0.05});
    return plate;
}

}  // namespace searchlight
