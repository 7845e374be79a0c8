#include "job/plot/figure_result.h"

#include <fmt/format.h>

#include "base/version.h"
#include "draw/draw.h"

namespace searchlight {

Json figureJson(const Figure& figure) {
    Json json;
    json["title"] = figure.title;
    if (!figure.caption.empty()) json["caption"] = figure.caption;
    if (figure.panels.empty()) {
        json["x"] = {{"label", figure.x.label}, {"unit", figure.x.unit}};
        json["y"] = {{"label", figure.y.label}, {"unit", figure.y.unit}};
        json["series"] = Json::array();
    }
    for (const Series& series : figure.series) {
        Json one{{"label", series.label}, {"x", series.x}, {"y", series.y}};
        if (!series.lower.empty()) {
            one["lower"] = series.lower;
            one["upper"] = series.upper;
        }
        json["series"].push_back(std::move(one));
    }
    if (figure.map) {
        json["map"] = {
            {"x_edges", figure.map->x_edges}, {"y_edges", figure.map->y_edges}, {"value", figure.map->values}};
        if (!figure.map->standard_error.empty()) json["map"]["stderr"] = figure.map->standard_error;
    }
    if (!figure.color.label.empty()) json["color"] = {{"label", figure.color.label}, {"unit", figure.color.unit}};
    for (const Figure& panel : figure.panels) json["panels"].push_back(figureJson(panel));
    return json;
}

JobResult figureResult(Figure figure, const Job& job, Observer& observer, const Json& values) {
    figure.metadata = {{"program", fmt::format("Searchlight {}", version())}, {"job", jobJson(job)}};
    JobResult result;
    Json document = documentJson("searchlight-figure/1", job);
    for (const Json& part : {figureJson(figure), values})
        for (const auto& [key, value] : part.items()) document[key] = value;
    if (job.output.empty())
        result.text = figureCsv(figure);
    else {
        drawFigure(figure, job.output);
        document["file"] = job.output;
        observer.log(LogLevel::info, fmt::format("wrote {}", job.output));
    }
    result.json = jsonText(document);
    return result;
}

AxisScale scaleNamed(const std::string& name) {
    return name == "lin" ? AxisScale::linear : name == "log" ? AxisScale::logarithmic : AxisScale::square_root;
}

PlotChannel channelNamed(const std::string& name) {
    return name == "R"   ? PlotChannel::red
           : name == "G" ? PlotChannel::green
           : name == "B" ? PlotChannel::blue
                         : PlotChannel::luminance;
}

}  // namespace searchlight
