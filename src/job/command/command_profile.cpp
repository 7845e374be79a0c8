// profile: R_d(r) of one model.
#include <fmt/format.h>

#include "base/files.h"
#include "base/text.h"
#include "job/command_table.h"
#include "job/json.h"
#include "job/shared_options.h"
#include "model/plane.h"
#include "model/sum_model.h"

namespace searchlight {

namespace {

// The table as the CSV that loads again as a measured profile.
std::string profileCsv(const Subject& subject, const std::string& title, std::string_view per,
                       std::span<const double> radii, std::span<const Rgb> Rd) {
    std::string csv = fmt::format("# title: {}\n# per: {}\n# material: {}\nr_mm,R,G,B\n", title, per, subject.name);
    for (std::size_t i = 0; i < radii.size(); ++i)
        csv += fmt::format("{},{},{},{}\n", radii[i], Rd[i].r, Rd[i].g, Rd[i].b);
    return csv;
}

JobResult runProfile(const Job& job, Engine& engine, Observer&) {
    const Options options(job);
    const Subject subject = subjectOf(job, engine);
    const Medium& medium = subject.medium;
    LoadedModel loaded = engine.load(options.text("model"), options.names("set"), options.text("backend"), medium);
    const double angle_deg = options.number("angle_deg");
    const double entry = options.text("per") == "incident" ? pencilBeam(medium.eta, angle_deg).transmittance : 1;

    std::vector<double> radii;
    double interpolation_error = 0;
    if (options.given("radii"))
        radii = options.list("radii");
    else {
        const Tabulation table = tabulate(*loaded.evaluator, loaded.model, medium);
        radii.assign(table.profile.radii().begin(), table.profile.radii().end());
        interpolation_error = table.max_relative_error;
    }
    std::vector<Rgb> Rd = radialRd(*loaded.evaluator, loaded.model, medium, angle_deg, radii);
    for (Rgb& value : Rd) value = entry * value;
    const Rgb total = entry * totalRd(*loaded.evaluator, loaded.model, medium, angle_deg);

    Json document = documentJson("searchlight-profile/1", job);
    document["per"] = options.text("per");
    document["model"] = loaded.model.id;
    document["backend"] = loaded.evaluator->backend();
    document["material"] = subjectJson(subject);
    document["angle_deg"] = angle_deg;
    document["radii_mm"] = radii;
    document["Rd"] = channelRows(Rd, medium);
    document["total"] = channelList(total, medium);
    if (hasDiffuseReflectance(loaded.model) && angle_deg == 0)
        document["total_closed_form"] =
            channelList(entry * loaded.evaluator->diffuseReflectance(medium.alphaPrime()), medium);
    document["unit"] = "1/mm^2";
    const std::string twice = countedTwice(loaded.model);
    if (!twice.empty()) document["notes"] = {twice};
    if (interpolation_error > 0) document["interpolation_error"] = interpolation_error;

    JobResult result;
    result.json = jsonText(document);
    result.text = fmt::format("{} of {}, per unit {} flux, {}\n{:>12}", loaded.model.file.title, subject.name,
                              options.text("per"), loaded.evaluator->backend(), "r / mm");
    for (int c = 0; c < medium.channels; ++c) result.text += fmt::format(" {:>14}", "R_d " + channelName(medium, c));
    for (std::size_t i = 0; i < radii.size(); ++i) {
        result.text += fmt::format("\n{:>12}", prettyNumber(radii[i], 6));
        for (int c = 0; c < medium.channels; ++c)
            result.text += medium.scatters(c) ? fmt::format(" {:>14.6e}", Rd[i][c]) : fmt::format(" {:>14}", "n/a");
    }
    result.text += fmt::format("\n{:>12}", "total");
    for (int c = 0; c < medium.channels; ++c)
        result.text += medium.scatters(c) ? fmt::format(" {:>14.6f}", total[c]) : fmt::format(" {:>14}", "n/a");
    result.text += "\n";
    if (!twice.empty()) result.text += twice + "\n";
    if (!job.output.empty())
        writeFile(job.output, job.output.ends_with(".csv")
                                  ? profileCsv(subject, loaded.model.file.title, options.text("per"), radii, Rd)
                                  : result.json + "\n");
    return result;
}

}  // namespace

Command profileCommand() {
    return {.name = "profile",
            .summary = "Evaluate R_d(r) of a model",
            .example = "searchlight profile --model dipole --material skin1 --radii 0.1,1,10",
            .options = {option::model(),
                        option::set(),
                        {.name = "radii",
                         .type = ParamType::numbers,
                         .unit = "mm",
                         .min = 0,
                         .max = option::unlimited,
                         .value = std::vector<double>{},
                         .doc = "where to evaluate; absent: an adaptive table"},
                        option::angle(),
                        {.name = "per",
                         .type = ParamType::choice,
                         .value = std::string("transmitted"),
                         .choices = {"transmitted", "incident"},
                         .doc = "per unit of which flux"},
                        option::backend()},
            .uses_material = true,
            .output = "profile: .json, or .csv that loads as a measured model",
            .run = runProfile};
}

}  // namespace searchlight
