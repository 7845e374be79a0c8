// plot slice: R_d over the surface in false colour.
#include <fmt/format.h>

#include "base/error.h"
#include "base/text.h"
#include "job/command_table.h"
#include "job/plot/figure_result.h"
#include "job/plot/plane_views.h"
#include "job/shared_options.h"

namespace searchlight {

namespace {

JobResult runPlotSlice(const Job& job, Engine& engine, Observer& observer) {
    const Options options(job);
    const Subject subject = comparableSubjectOf(job, engine);
    const PlotChannel channel = channelNamed(options.text("channel"));
    requireScattering(subject, channel);
    const double angle_deg = options.number("angle_deg");
    const int cells = static_cast<int>(options.number("cells"));
    double extent = options.number("extent");
    if (extent == 0) extent = 0.5 * stripOf(subject.medium, 0, 0, 2).edges_mm.back();
    std::vector<LoadedModel> models = loadModels(options.names("models"), options.text("backend"), subject, engine);

    std::optional<ReferenceRun> run;
    if (const double walks = options.number("reference_walks"); walks > 0) {
        ReferenceOptions reference;
        reference.walks = static_cast<std::uint64_t>(walks);
        reference.seed = job.seed;
        reference.angle_deg = angle_deg;
        reference.threads = static_cast<int>(options.number("threads"));
        reference.grid = cells;
        reference.grid_extent_mm = extent;
        walkOnly(channel, reference);
        run = runReference(subject.medium, reference, observer);
    }
    const std::vector<SlicePanel> panels = slicePanels(models, angle_deg, extent, cells, run ? &*run : nullptr);
    const std::string title = fmt::format("Diffuse reflectance of {}{}, beam at {}°", subject.name,
                                          subject.medium.channels == 1 ? "" : fmt::format(", {}", channelName(channel)),
                                          prettyNumber(angle_deg));
    const int columns = panels.size() <= 4   ? static_cast<int>(panels.size() == 4 ? 2 : panels.size())
                        : panels.size() <= 6 ? 3
                                             : 4;
    return figureResult(sliceFigure(panels, {.channel = channel,
                                             .title = title,
                                             .extent_mm = extent,
                                             .columns = columns,
                                             .decades = options.number("decades")}),
                        job, observer);
}

}  // namespace

Command plotSliceCommand() {
    return {.name = "plot slice",
            .summary = "Show R_d over the surface in false colour, models beside the reference",
            .example =
                "searchlight plot slice --material lowfat_milk --angle-deg 60 --models "
                "dipole,directional_dipole -o slice.png",
            .options = {option::models(),
                        option::walks(4e6, "reference_walks", "random walks of the reference per channel; 0: none", 0),
                        option::channel(),
                        option::angle(),
                        {.name = "extent",
                         .unit = "mm",
                         .min = 0,
                         .max = option::unlimited,
                         .value = 0.0,
                         .doc = "half the side of the square; 0: chosen from the medium"},
                        {.name = "cells",
                         .type = ParamType::integer,
                         .min = 2,
                         .max = 512,
                         .value = 64.0,
                         .doc = "cells per side"},
                        {.name = "decades",
                         .min = 0.1,
                         .max = 20,
                         .value = 4.0,
                         .doc = "most powers of ten that the colours span"},
                        option::backend(),
                        option::threads()},
            .uses_material = true,
            .uses_seed = true,
            .output = "figure: .svg, .png, .pdf or .csv",
            .run = runPlotSlice};
}

}  // namespace searchlight
