// plot moments: how far light moves, against the angle of incidence.
#include "plot/moments.h"

#include <fmt/format.h>

#include <cmath>

#include "base/error.h"
#include "base/text.h"
#include "job/command_table.h"
#include "job/plot/figure_result.h"
#include "job/plot/plane_views.h"
#include "job/shared_options.h"

namespace searchlight {

namespace {

Json estimatesJson(const std::vector<Estimate>& estimates) {
    Json means = Json::array(), errors = Json::array();
    for (const Estimate& estimate : estimates) {
        means.push_back(estimate.mean);
        errors.push_back(estimate.standard_error);
    }
    return {{"mean", means}, {"stderr", errors}};
}

JobResult runPlotMoments(const Job& job, Engine& engine, Observer& observer) {
    const Options options(job);
    const Subject subject = comparableSubjectOf(job, engine);
    const Medium& medium = subject.medium;
    const PlotChannel channel = channelNamed(options.text("channel"));
    requireScattering(subject, channel);
    const int index = channelIndex(medium, channel);
    const std::vector<double>& angles = options.list("angle_deg");
    if (angles.empty()) throw usageError("--angle-deg names no angle", "--angle-deg 0,30,60");
    std::vector<LoadedModel> models = loadModels(options.names("models"), options.text("backend"), subject, engine);

    Json by_model = Json::array();
    std::vector<MomentCurve> curves;
    for (LoadedModel& model : models) {
        MomentCurve curve{.label = modelLabel(model)};
        for (const double angle_deg : angles) {
            const PlaneMoments moments = planeMoments(*model.evaluator, model.model, medium, angle_deg);
            curve.mean_x_mm.push_back(moments.mean_x[index]);
            curve.mean_r2_mm2.push_back(moments.mean_r2[index]);
        }
        by_model.push_back({{"model", model.model.id},
                            {"label", curve.label},
                            {"mean_x_mm", curve.mean_x_mm},
                            {"mean_r2_mm2", curve.mean_r2_mm2}});
        curves.push_back(std::move(curve));
    }
    Json values{{"angles_deg", angles}, {"models", by_model}};
    MomentReference reference;
    const double walks = options.number("reference_walks");
    if (walks > 0) {
        for (const double angle_deg : angles) {
            ReferenceOptions walk;
            walk.walks = static_cast<std::uint64_t>(walks);
            walk.seed = job.seed;
            walk.angle_deg = angle_deg;
            walk.threads = static_cast<int>(options.number("threads"));
            walkOnly(channel, walk);
            const ReferenceRun run = runReference(medium, walk, observer);
            const HalfSpaceTally& all = run.channels[static_cast<std::size_t>(index)]->all;
            reference.label = walksLabel(run);
            reference.mean_x_mm.push_back(all.mean_x_mm);
            reference.mean_r2_mm2.push_back(all.mean_r2_mm2);
        }
        values["reference"] = {{"mean_x_mm", estimatesJson(reference.mean_x_mm)},
                               {"mean_r2_mm2", estimatesJson(reference.mean_r2_mm2)}};
    }
    const std::string title = fmt::format("How far light moves in {}{}", subject.name,
                                          medium.channels == 1 ? "" : fmt::format(", {}", channelName(channel)));
    return figureResult(momentsFigure(angles, curves, walks > 0 ? &reference : nullptr, title), job, observer, values);
}

}  // namespace

Command plotMomentsCommand() {
    Param channel = option::channel();
    channel.choices.pop_back();  // moments of three channels do not add up to those of luminance
    return {.name = "plot moments",
            .summary = "Plot mean shift and mean square radius against the angle of incidence",
            .example = "searchlight plot moments --material lowfat_milk --models all -o moments.svg",
            .options = {option::models(),
                        option::walks(1e6, "reference_walks", "random walks of the reference per angle; 0: none", 0),
                        channel, option::angles({0, 15, 30, 45, 60, 75}), option::backend(), option::threads()},
            .uses_material = true,
            .uses_seed = true,
            .output = "figure: .svg, .png, .pdf or .csv",
            .run = runPlotMoments};
}

}  // namespace searchlight
