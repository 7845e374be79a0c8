// plot oblique: R_d along the plane of incidence.
#include <fmt/format.h>

#include "base/error.h"
#include "base/text.h"
#include "job/command_table.h"
#include "job/plot/figure_result.h"
#include "job/plot/plane_views.h"
#include "job/shared_options.h"

namespace searchlight {

namespace {

JobResult runPlotOblique(const Job& job, Engine& engine, Observer& observer) {
    const Options options(job);
    const Subject subject = comparableSubjectOf(job, engine);
    const PlotChannel channel = channelNamed(options.text("channel"));
    requireScattering(subject, channel);
    if (options.list("angle_deg").empty()) throw usageError("--angle-deg names no angle", "--angle-deg 0,30,60");
    const int cells = static_cast<int>(options.number("cells"));
    const Strip strip = stripOf(subject.medium, options.number("extent"), options.number("strip"), cells + cells % 2);
    std::vector<LoadedModel> models = loadModels(options.names("models"), options.text("backend"), subject, engine);

    std::vector<StripPanel> panels;
    Json found = Json::array();
    for (const double angle_deg : options.list("angle_deg")) {
        StripPanel panel{.heading = fmt::format("{}°", prettyNumber(angle_deg)),
                         .edges_mm = strip.edges_mm,
                         .half_width_mm = strip.half_width_mm};
        for (LoadedModel& model : models)
            panel.models.push_back({modelLabel(model), incidentCellMeans(model, angle_deg, strip.cells())});
        if (const double walks = options.number("reference_walks"); walks > 0) {
            ReferenceOptions reference;
            reference.walks = static_cast<std::uint64_t>(walks);
            reference.seed = job.seed;
            reference.angle_deg = angle_deg;
            reference.threads = static_cast<int>(options.number("threads"));
            reference.strip_edges_mm = strip.edges_mm;
            reference.strip_half_width_mm = strip.half_width_mm;
            walkOnly(channel, reference);
            panel.reference.push_back(stripReference(runReference(subject.medium, reference, observer)));
        }
        Json shapes = Json::array();
        const auto add = [&](const std::string& label, const std::vector<Rgb>& means) {
            const StripShape shape = stripShape(means, strip.edges_mm, channel);
            shapes.push_back({{"label", label},
                              {"peak", shape.peak},
                              {"peak_x_mm", shape.peak_x_mm},
                              {"mean_x_mm", shape.mean_x_mm}});
        };
        for (const StripCurve& curve : panel.models) add(curve.label, curve.means);
        for (const StripReference& curve : panel.reference) add(curve.label, curve.Rd);
        found.push_back({{"angle_deg", angle_deg}, {"shapes", shapes}});
        panels.push_back(std::move(panel));
    }
    const std::string title =
        fmt::format("Plane of incidence, {}{}", subject.name,
                    subject.medium.channels == 1 ? "" : fmt::format(", {}", channelName(channel)));
    return figureResult(
        obliqueFigure(panels, {.channel = channel, .y_scale = scaleNamed(options.text("y_scale")), .title = title}),
        job, observer, {{"strip", {{"half_width_mm", strip.half_width_mm}}}, {"angles", found}});
}

}  // namespace

Command plotObliqueCommand() {
    return {.name = "plot oblique",
            .summary = "Plot R_d on both sides of an oblique beam, beside the reference",
            .example = "searchlight plot oblique --material lowfat_milk --angle-deg 60 --models all -o oblique.svg",
            .options = {option::models(),
                        option::walks(1e6, "reference_walks", "random walks of the reference per channel; 0: none", 0),
                        option::channel(),
                        option::scale("y_scale", "log"),
                        option::angles({60}),
                        {.name = "extent",
                         .unit = "mm",
                         .min = 0,
                         .max = option::unlimited,
                         .value = 0.0,
                         .doc = "largest distance on both sides; 0: chosen from the medium"},
                        {.name = "strip",
                         .unit = "mm",
                         .min = 0,
                         .max = option::unlimited,
                         .value = 0.0,
                         .doc = "half the width of the strip that is averaged over; 0: 1/80 of the extent"},
                        {.name = "cells",
                         .type = ParamType::integer,
                         .min = 2,
                         .max = 4096,
                         .value = 96.0,
                         .doc = "cells of the strip, both sides together"},
                        option::backend(),
                        option::threads()},
            .uses_material = true,
            .uses_seed = true,
            .output = "figure: .svg, .png, .pdf or .csv",
            .run = runPlotOblique};
}

}  // namespace searchlight
