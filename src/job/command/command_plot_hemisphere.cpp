// plot hemisphere: outgoing radiance at a point over all directions.
#include "plot/hemisphere.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/text.h"
#include "job/command_table.h"
#include "job/plot/figure_result.h"
#include "job/plot/plane_views.h"
#include "job/shared_options.h"
#include "transport/half_space/radiance.h"

namespace searchlight {

namespace {

Rgb gray(double value) { return {value, value, value}; }

JobResult runPlotHemisphere(const Job& job, Engine& engine, Observer& observer) {
    const Options options(job);
    const Subject subject = comparableSubjectOf(job, engine);
    const Medium& medium = subject.medium;
    const PlotChannel channel = channelNamed(options.text("channel"));
    requireScattering(subject, channel);
    const int index = channelIndex(medium, channel);
    const double angle_deg = options.number("angle_deg");
    const double radius = options.given("radius") ? options.number("radius") : 1 / medium.sigmaTp()[index];
    if (!(radius > 0)) throw usageError("--radius is 0", "the point stands beside the beam, not in it");
    const double spread = options.number("spread");
    HemisphereOptions look{.channel = channel,
                           .polar = static_cast<int>(options.number("polar")),
                           .turns = 2 * static_cast<int>(std::ceil(0.5 * options.number("turns")))};
    const PlaneSector sector{.r0_mm = radius * (1 - spread),
                             .r1_mm = radius * (1 + spread),
                             .azimuth_deg = options.number("azimuth_deg"),
                             .half_width_deg = options.number("sector_deg")};
    std::vector<LoadedModel> models = loadModels(options.names("models"), options.text("backend"), subject, engine);

    std::vector<HemispherePanel> panels;
    Json values{{"sector",
                 {{"r0_mm", sector.r0_mm},
                  {"r1_mm", sector.r1_mm},
                  {"azimuth_deg", sector.azimuth_deg},
                  {"half_width_deg", sector.half_width_deg}}}};
    if (const double walks = options.number("reference_walks"); walks > 0) {
        const RadianceResult walked = walkRadiance(halfSpaceProblem(medium, index, angle_deg),
                                                   {.walks = static_cast<std::uint64_t>(walks),
                                                    .seed = job.seed,
                                                    .r0_mm = sector.r0_mm,
                                                    .r1_mm = sector.r1_mm,
                                                    .azimuth_deg = sector.azimuth_deg,
                                                    .half_width_deg = sector.half_width_deg,
                                                    .polar = look.polar,
                                                    .turns = look.turns,
                                                    .threads = static_cast<int>(options.number("threads"))},
                                                   observer);
        HemispherePanel panel{.heading = fmt::format("Monte Carlo, {} walks", countText(walks))};
        for (const double value : walked.radiance) panel.radiance.push_back(gray(value));
        for (const double value : walked.standard_error) panel.standard_error.push_back(gray(value));
        panels.push_back(std::move(panel));
        values["exitance"] = {{"mean", walked.exitance.mean}, {"stderr", walked.exitance.standard_error}};
    }
    const double entry = pencilBeam(medium.eta, angle_deg).transmittance;
    for (LoadedModel& model : models) {
        HemispherePanel panel{.heading = modelLabel(model)};
        for (const Rgb& value : sectorRadiance(*model.evaluator, medium, angle_deg, sector, look.polar, look.turns))
            panel.radiance.push_back(gray(entry * value[index]));
        panels.push_back(std::move(panel));
    }
    look.title =
        fmt::format("Outgoing radiance, {}{}, beam at {}°", subject.name,
                    medium.channels == 1 ? "" : fmt::format(", {}", channelName(channel)), prettyNumber(angle_deg));
    look.place = fmt::format("between {} and {} mm from the beam, {} ± {}° about it", prettyNumber(sector.r0_mm, 3),
                             prettyNumber(sector.r1_mm, 3), prettyNumber(sector.azimuth_deg),
                             prettyNumber(sector.half_width_deg));
    return figureResult(hemisphereFigure(panels, look), job, observer, values);
}

}  // namespace

Command plotHemisphereCommand() {
    Param channel = option::channel();
    channel.choices.pop_back();  // one channel is walked
    return {.name = "plot hemisphere",
            .summary = "Show the radiance that leaves a point over the hemisphere of directions",
            .example =
                "searchlight plot hemisphere --sigma-a 0.01 --sigma-s 1 --g 0 --eta 1 --angle-deg 60 --radius 1 "
                "--models directional_dipole -o hemisphere.svg",
            .options = {option::models(),
                        option::walks(4e6, "reference_walks", "random walks of the reference; 0: none", 0),
                        channel,
                        option::angle(),
                        {.name = "radius",
                         .unit = "mm",
                         .min = 0,
                         .max = option::unlimited,
                         .value = 0.0,
                         .doc = "of the point, from the beam (default: one mean free path)"},
                        {.name = "azimuth_deg",
                         .unit = "deg",
                         .min = -180,
                         .max = 180,
                         .value = 0.0,
                         .doc = "of the point; 0 is the side that the beam leans to"},
                        {.name = "spread",
                         .min = 0.01,
                         .max = 1,
                         .value = 0.25,
                         .doc = "the point is widened to radius times 1 - spread to 1 + spread"},
                        {.name = "sector_deg",
                         .unit = "deg",
                         .min = 0.1,
                         .max = 180,
                         .value = 15.0,
                         .doc = "and to this angle on both sides"},
                        {.name = "polar",
                         .type = ParamType::integer,
                         .min = 1,
                         .max = 90,
                         .value = 9.0,
                         .doc = "cells of the polar angle"},
                        {.name = "turns",
                         .type = ParamType::integer,
                         .min = 2,
                         .max = 360,
                         .value = 24.0,
                         .doc = "cells of the azimuth, even"},
                        option::backend(),
                        option::threads()},
            .uses_material = true,
            .uses_seed = true,
            .output = "figure: .svg, .png, .pdf or .csv",
            .run = runPlotHemisphere};
}

}  // namespace searchlight
