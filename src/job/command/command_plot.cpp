// plot pencil, plot error, plot albedo: figures.
#include "plot/albedo.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/text.h"
#include "job/command_table.h"
#include "job/plot/curves.h"
#include "job/plot/figure_result.h"
#include "job/shared_options.h"
#include "model/plane.h"

namespace searchlight {

namespace {

struct PencilData {
    std::vector<PencilCurve> models;
    std::optional<PencilReference> reference;
    PencilOptions options;
};

PencilData pencilData(const Job& job, Engine& engine, Observer& observer, bool needs_reference) {
    const Options options(job);
    const Subject subject = comparableSubjectOf(job, engine);
    const Medium& medium = subject.medium;
    PencilData data;
    data.options.channel = channelNamed(options.text("channel"));
    data.options.x_scale = scaleNamed(options.text("x_scale"));
    data.options.angle_deg = options.number("angle_deg");
    data.options.material = subject.name;
    if (data.options.channel != PlotChannel::luminance && medium.channels == 3 &&
        !medium.scatters(static_cast<int>(data.options.channel)))
        throw inputError(fmt::format("{} does not scatter in channel {}: there is nothing to plot", subject.name,
                                     options.text("channel")),
                         "choose another --channel");

    const double walks = options.number("reference_walks");
    ReferenceOptions reference;
    reference.walks = static_cast<std::uint64_t>(walks);
    reference.seed = job.seed;
    reference.angle_deg = data.options.angle_deg;
    reference.threads = static_cast<int>(options.number("threads"));
    const bool all_channels = data.options.channel == PlotChannel::luminance || !options.text("solo").empty();
    for (int c = 0; c < Rgb::channels; ++c)
        reference.only[c] = all_channels || c == static_cast<int>(data.options.channel);
    double r_max = options.number("radii_max");
    reference.edges_mm = plotEdges(medium, r_max, static_cast<int>(options.number("bins")));
    r_max = reference.edges_mm.back();

    const bool solo = !options.text("solo").empty();
    std::vector<LoadedModel> loaded = loadModels(solo ? std::vector{options.text("solo")} : options.names("models"),
                                                 options.text("backend"), subject, engine);
    if (walks > 0 || needs_reference) data.reference = runReference(medium, reference, observer).curve();
    const std::vector<double> edges = data.reference ? reference.edges_mm : std::vector<double>{};
    for (LoadedModel& model : loaded)
        data.models.push_back(modelCurve(model, data.options.angle_deg, curveRadii(r_max), edges));
    if (solo) data.options.solo = data.models.front().label;
    return data;
}

JobResult runPlotPencil(const Job& job, Engine& engine, Observer& observer) {
    const Options options(job);
    PencilData data = pencilData(job, engine, observer, false);
    data.options.y_scale = scaleNamed(options.text("y_scale"));
    data.options.radius_power = static_cast<int>(options.number("times_radius"));
    return figureResult(pencilFigure(data.models, data.reference ? &*data.reference : nullptr, data.options), job,
                        observer);
}

JobResult runPlotError(const Job& job, Engine& engine, Observer& observer) {
    const PencilData data = pencilData(job, engine, observer, true);
    return figureResult(relativeErrorFigure(data.models, *data.reference, data.options), job, observer);
}

JobResult runPlotAlbedo(const Job& job, Engine& engine, Observer& observer) {
    const Options options(job);
    const AlbedoData data = albedoData(options.number("eta"), options.number("g"), options.names("models"),
                                       static_cast<std::uint64_t>(options.number("reference_walks")), job.seed,
                                       options.text("backend"), engine, observer);
    return figureResult(albedoFigure(data.models, data.reference ? &*data.reference : nullptr, options.number("eta")),
                        job, observer);
}

}  // namespace

Command plotPencilCommand() {
    return {.name = "plot pencil",
            .summary = "Plot the searchlight profiles of models, beside the reference",
            .example =
                "searchlight plot pencil --material skin1 --models dipole,better_dipole --reference-walks 1e6 -o "
                "pencil.svg",
            .options = {option::models(),
                        option::walks(0, "reference_walks", "random walks of the reference per channel; 0: none", 0),
                        option::channel(),
                        option::scale("x_scale", "lin"),
                        option::scale("y_scale", "log"),
                        {.name = "times_radius",
                         .type = ParamType::integer,
                         .min = 0,
                         .max = 2,
                         .value = 0.0,
                         .doc = "plot R_d r^n"},
                        option::solo(),
                        option::angle(),
                        option::radiiMax(),
                        option::bins(64),
                        option::backend(),
                        option::threads()},
            .uses_material = true,
            .uses_seed = true,
            .output = "figure: .svg, .png, .pdf or .csv",
            .run = runPlotPencil};
}

Command plotErrorCommand() {
    return {.name = "plot error",
            .summary = "Plot the relative error of models against the reference",
            .example = "searchlight plot error --material skin1 --models all --reference-walks 1e6 -o error.svg",
            .options = {option::models(),
                        option::walks(1e6, "reference_walks", "random walks of the reference per channel"),
                        option::channel(), option::scale("x_scale", "sqrt"), option::solo(), option::angle(),
                        option::radiiMax(), option::bins(64), option::backend(), option::threads()},
            .uses_material = true,
            .uses_seed = true,
            .output = "figure: .svg, .png, .pdf or .csv",
            .run = runPlotError};
}

Command plotAlbedoCommand() {
    return {
        .name = "plot albedo",
        .summary = "Plot total diffuse reflectance against albedo",
        .example = "searchlight plot albedo --eta 1.3 --reference-walks 1e5 -o albedo.svg",
        .options = {option::models(),
                    {.name = "eta", .min = .25, .max = 4, .value = 1.3, .doc = "refractive index, inside over outside"},
                    {.name = "g", .min = -.99, .max = .99, .value = 0.0, .doc = "mean cosine of the phase function"},
                    option::walks(0, "reference_walks", "random walks per point of the reference; 0: none", 0),
                    option::backend()},
        .uses_seed = true,
        .output = "figure: .svg, .png, .pdf or .csv",
        .run = runPlotAlbedo};
}

}  // namespace searchlight
