// plot pencil, plot error, plot albedo: figures.
#include "plot/albedo.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/text.h"
#include "base/version.h"
#include "draw/draw.h"
#include "job/command_table.h"
#include "job/curves.h"
#include "job/json.h"
#include "model/plane.h"

namespace searchlight {

namespace {

AxisScale scaleNamed(const std::string& name) {
    return name == "lin" ? AxisScale::linear : name == "log" ? AxisScale::logarithmic : AxisScale::square_root;
}

PlotChannel channelNamed(const std::string& name) {
    return name == "R"   ? PlotChannel::red
           : name == "G" ? PlotChannel::green
           : name == "B" ? PlotChannel::blue
                         : PlotChannel::luminance;
}

// Draws into the job's output, or hands the numbers out as CSV.
JobResult finish(Figure figure, const Job& job, Observer& observer) {
    figure.metadata = {{"program", fmt::format("Searchlight {}", version())}, {"job", jobJson(job)}};
    JobResult result;
    Json document = documentJson("searchlight-figure/1", job);
    document["title"] = figure.title;
    document["caption"] = figure.caption;
    document["x"] = {{"label", figure.x.label}, {"unit", figure.x.unit}};
    document["y"] = {{"label", figure.y.label}, {"unit", figure.y.unit}};
    document["series"] = Json::array();
    for (const Series& series : figure.series) {
        Json json{{"label", series.label}, {"x", series.x}, {"y", series.y}};
        if (!series.lower.empty()) {
            json["lower"] = series.lower;
            json["upper"] = series.upper;
        }
        document["series"].push_back(std::move(json));
    }
    if (job.output.empty())
        result.text = figureCsv(figure);
    else {
        drawFigure(figure, job.output);
        document["file"] = job.output;
        observer.log(LogLevel::info, fmt::format("wrote {}", job.output));
    }
    result.json = document.dump(1);
    return result;
}

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

}  // namespace

JobResult runPlotPencil(const Job& job, Engine& engine, Observer& observer) {
    const Options options(job);
    PencilData data = pencilData(job, engine, observer, false);
    data.options.y_scale = scaleNamed(options.text("y_scale"));
    data.options.radius_power = static_cast<int>(options.number("times_radius"));
    return finish(pencilFigure(data.models, data.reference ? &*data.reference : nullptr, data.options), job, observer);
}

JobResult runPlotError(const Job& job, Engine& engine, Observer& observer) {
    const PencilData data = pencilData(job, engine, observer, true);
    return finish(relativeErrorFigure(data.models, *data.reference, data.options), job, observer);
}

JobResult runPlotAlbedo(const Job& job, Engine& engine, Observer& observer) {
    const Options options(job);
    const AlbedoData data = albedoData(options.number("eta"), options.number("g"), options.names("models"),
                                       static_cast<std::uint64_t>(options.number("reference_walks")), job.seed,
                                       options.text("backend"), engine, observer);
    return finish(albedoFigure(data.models, data.reference ? &*data.reference : nullptr, options.number("eta")), job,
                  observer);
}

}  // namespace searchlight
