#include "gui/plot/plot_options.h"

#include <algorithm>

#include "gui/state/command_line.h"
#include "job/plot/figure_result.h"

namespace searchlight::gui {

namespace {

const std::string& text(const State& state, std::string_view name) {
    return std::get<std::string>(optionOf(state, "plot", name));
}

double number(const State& state, std::string_view name) { return std::get<double>(optionOf(state, "plot", name)); }

LiveRequest::View viewNamed(const std::string& name) {
    if (name == "error") return LiveRequest::View::error;
    if (name == "plane") return LiveRequest::View::plane;
    return name == "slice" ? LiveRequest::View::slice : LiveRequest::View::profile;
}

}  // namespace

std::vector<Param> plotOptions() {
    return {
        {.name = "view",
         .type = ParamType::choice,
         .value = std::string("profile"),
         .choices = {"profile", "error", "plane", "slice"},
         .doc = "R_d over the radius, its relative error, along the plane of incidence, or over the surface"},
        {.name = "channel",
         .type = ParamType::choice,
         .value = std::string("R"),
         .choices = {"R", "G", "B", "luminance"},
         .doc = "which channel is plotted"},
        {.name = "x_scale",
         .type = ParamType::choice,
         .value = std::string("lin"),
         .choices = {"lin", "log", "sqrt"},
         .doc = "of the radius"},
        {.name = "y_scale",
         .type = ParamType::choice,
         .value = std::string("log"),
         .choices = {"lin", "log", "sqrt"},
         .doc = "of the reflectance"},
        {.name = "times_radius",
         .type = ParamType::choice,
         .value = std::string("0"),
         .choices = {"0", "1", "2"},
         .doc = "plot R_d r^n: damps the peak at the beam"},
        {.name = "angle_deg", .unit = "deg", .min = 0, .max = 89, .value = 0.0, .doc = "of incidence"},
        {.name = "radii_max",
         .unit = "mm",
         .min = 0,
         .max = 1e4,
         .value = 0.0,
         .doc = "where the radius ends; 0: chosen"},
        {.name = "walks",
         .type = ParamType::choice,
         .value = std::string("1e6"),
         .choices = {"0", "1e5", "1e6", "1e7"},
         .doc = "random walks of the reference per channel; 0: no reference"},
    };
}

std::vector<int> plottedSlots(const State& state) {
    std::vector<int> found;
    for (int i = 0; i < static_cast<int>(state.models.size()); ++i)
        if (state.solo == i || (state.solo < 0 && state.models[static_cast<std::size_t>(i)].visible))
            found.push_back(i);
    return found;
}

LiveRequest plotRequest(const State& state) {
    LiveRequest request;
    request.view = viewNamed(text(state, "view"));
    for (const int i : plottedSlots(state)) {
        const ModelSlot& slot = state.models[static_cast<std::size_t>(i)];
        request.models.push_back({slot.model, slot.material, slot.color});
    }
    if (state.solo >= 0) request.solo = 0;
    request.material = state.scene.material;
    request.inverted_by = state.activeModel().model;
    request.channel = channelNamed(text(state, "channel"));
    request.x_scale = scaleNamed(text(state, "x_scale"));
    request.y_scale = scaleNamed(text(state, "y_scale"));
    request.radius_power = std::stoi(text(state, "times_radius"));
    request.angle_deg = number(state, "angle_deg");
    request.radii_max_mm = number(state, "radii_max");
    request.walks = std::stod(text(state, "walks"));
    request.seed = state.seed;
    return request;
}

QString plotCommandLine(const State& state) {
    const std::string& view = text(state, "view");
    const char* const command = view == "error"   ? "error"
                                : view == "plane" ? "oblique"
                                : view == "slice" ? "slice"
                                                  : "pencil";
    QStringList models;
    for (const int i : plottedSlots(state)) {
        const SceneModel& model = state.models[static_cast<std::size_t>(i)].model;
        QString name = QString::fromStdString(model.id);
        for (const auto& [key, value] : model.parameters)
            name += QStringLiteral(":%1=%2").arg(QString::fromStdString(key), QString::fromStdString(valueText(value)));
        models << name;
    }
    QString line = QStringLiteral("searchlight plot %1 --models %2")
                       .arg(QLatin1String(command),
                            QString::fromStdString(shellWord(models.join(QLatin1Char(',')).toStdString())));
    for (const std::string& flag : materialFlags(state.scene.material, &state.activeModel().model))
        line += QLatin1Char(' ') + QString::fromStdString(flag);
    line += QStringLiteral(" --angle-deg %1 --channel %2 --reference-walks %3")
                .arg(QString::number(number(state, "angle_deg")), QString::fromStdString(text(state, "channel")),
                     QString::fromStdString(text(state, "walks")));
    if (view == "profile")
        line += QStringLiteral(" --times-radius %1").arg(QString::fromStdString(text(state, "times_radius")));
    if (view == "profile" || view == "error")
        line += QStringLiteral(" --x-scale %1").arg(QString::fromStdString(text(state, "x_scale")));
    if (view == "profile" || view == "plane")
        line += QStringLiteral(" --y-scale %1").arg(QString::fromStdString(text(state, "y_scale")));
    return line + QStringLiteral(" -o %1.svg").arg(QLatin1String(command));
}

}  // namespace searchlight::gui
