// report: every model beside the reference on one material, as a page with figures and numbers.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/error.h"
#include "base/files.h"
#include "base/text.h"
#include "base/version.h"
#include "draw/draw.h"
#include "draw/report.h"
#include "job/command_table.h"
#include "job/json.h"
#include "job/plot/curves.h"
#include "job/shared_options.h"
#include "model/plane.h"
#include "validate/curve_error.h"

namespace searchlight {

namespace {

namespace fs = std::filesystem;

struct NamedFigure {
    std::string stem;
    Figure figure;
};

// One model against the reference, one row a channel.
struct Judged {
    std::string label;
    std::string id;
    bool reads_medium = true;
    std::vector<CurveError> errors;  // per scattering channel
    std::vector<double> totals, true_totals, true_errors;

    /// Error of R_d, mean over the channels.
    double error() const {
        double sum = 0;
        for (const CurveError& error : errors) sum += error.weighted;
        return errors.empty() ? 0 : sum / static_cast<double>(errors.size());
    }
};

std::string percent(double fraction) { return fmt::format("{:.1f} %", 100 * fraction); }
std::string signedPercent(double fraction) { return fmt::format("{:+.1f} %", 100 * fraction); }

std::vector<int> scatteringChannels(const Medium& medium) {
    std::vector<int> channels;
    for (int c = 0; c < medium.channels; ++c)
        if (medium.scatters(c)) channels.push_back(c);
    return channels;
}

std::vector<Judged> judge(std::vector<LoadedModel>& models, const std::vector<PencilCurve>& curves,
                          const PencilReference& reference, const ReferenceRun& run, double entry) {
    std::vector<Judged> judged;
    for (std::size_t m = 0; m < models.size(); ++m) {
        Judged row{.label = curves[m].label, .id = models[m].model.id, .reads_medium = readsMedium(models[m].model)};
        const Rgb total = entry * totalRd(*models[m].evaluator, models[m].model, run.medium, run.angle_deg);
        for (const int c : scatteringChannels(run.medium)) {
            const double mean_free_path = 1 / run.medium.sigmaTp()[c];
            row.errors.push_back(curveError(curves[m].bin_means, reference.Rd, reference.standard_error,
                                            reference.edges_mm, c, mean_free_path));
            const Estimate& truth = run.channels[static_cast<std::size_t>(c)]->all.total;
            row.totals.push_back(total[c]);
            row.true_totals.push_back(truth.mean);
            row.true_errors.push_back(truth.standard_error);
        }
        judged.push_back(std::move(row));
    }
    std::stable_sort(judged.begin(), judged.end(),
                     [](const Judged& a, const Judged& b) { return a.error() < b.error(); });
    return judged;
}

ReportSection materialSection(const Subject& subject) {
    ReportSection section{.heading = "Material"};
    const Medium& medium = subject.medium;
    ReportTable table{.caption = "Lengths in mm, coefficients in 1/mm; eta = " + prettyNumber(medium.eta) + ".",
                      .header = {"channel", "sigma_a", "sigma_s", "g", "sigma_s'", "albedo'", "mean free path'",
                                 "diffuse mean free path"}};
    for (int c = 0; c < medium.channels; ++c) {
        const double sigma_tp = medium.sigmaTp()[c];
        const double sigma_tr = std::sqrt(3 * medium.sigma_a[c] * sigma_tp);
        std::vector<std::string> row{medium.channels == 1 ? "all" : channelName(medium, c)};
        for (const double value : {medium.sigma_a[c], medium.sigma_s[c], medium.g[c], medium.sigmaSp()[c],
                                   medium.alphaPrime()[c], 1 / sigma_tp})
            row.push_back(prettyNumber(value));
        row.push_back(sigma_tr > 0 ? prettyNumber(1 / sigma_tr) : "infinite");
        table.rows.push_back(std::move(row));
    }
    section.paragraphs.push_back(fmt::format("{} ({}).", subject.name, subject.source));
    for (const std::string& note : subject.notes) section.paragraphs.push_back(note);
    section.tables.push_back(std::move(table));
    return section;
}

ReportSection errorSection(const std::vector<Judged>& judged, const ReferenceRun& run) {
    ReportSection section{.heading = "Errors"};
    ReportTable table{
        .caption =
            "Error of R_d: ∫ |model − reference| 2πr dr over ∫ reference 2πr dr; near and far are the same below and "
            "above one reduced mean free path. Noise: what a perfect model would show, from the reference's own "
            "standard error. Total: diffuse reflectance per unit incident flux, and its difference from the "
            "reference. Fixed: a profile in mm that does not follow the medium.",
        .header = {"model", "channel", "error of R_d", "near", "far", "noise", "total", "reference", "difference"}};
    const std::vector<int> channels = scatteringChannels(run.medium);
    for (const Judged& row : judged)
        for (std::size_t i = 0; i < channels.size(); ++i) {
            const CurveError& error = row.errors[i];
            table.rows.push_back({i == 0 ? row.label + (row.reads_medium ? "" : " (fixed)") : "",
                                  channelName(run.medium, channels[i]), percent(error.weighted), percent(error.near),
                                  percent(error.far), percent(error.noise), fmt::format("{:.4f}", row.totals[i]),
                                  fmt::format("{:.4f}", row.true_totals[i]),
                                  signedPercent(row.totals[i] / row.true_totals[i] - 1)});
        }
    section.tables.push_back(std::move(table));
    return section;
}

ReportSection referenceSection(const ReferenceRun& run, std::uint64_t seed) {
    ReportSection section{.heading = "Reference"};
    ReportTable table{.caption =
                          "Unbiased Monte Carlo of a pencil beam on a half-space, smooth Fresnel boundary, "
                          "Henyey-Greenstein phase function; fractions of the incident flux, with one standard error.",
                      .header = {"channel", "specular", "diffuse", "single", "multiple", "walks", "walks/s"}};
    for (int c = 0; c < run.medium.channels; ++c) {
        const auto& walked = run.channels[static_cast<std::size_t>(c)];
        const std::string name = run.medium.channels == 1 ? "all" : channelName(run.medium, c);
        if (!walked) {
            table.rows.push_back({name, "not applicable", "", "", "", "", ""});
            continue;
        }
        const auto text = [](const Estimate& e) { return fmt::format("{:.5f} ± {:.5f}", e.mean, e.standard_error); };
        table.rows.push_back({name, fmt::format("{:.5f}", walked->specular), text(walked->all.total),
                              text(walked->single.total), text(walked->multiple.total),
                              fmt::format("{:.3g}", static_cast<double>(walked->walks)),
                              fmt::format("{:.3g}", static_cast<double>(walked->walks) / walked->seconds)});
    }
    section.paragraphs.push_back(fmt::format("Seed {}, {:.2g} s of walking.", seed, run.seconds()));
    section.tables.push_back(std::move(table));
    return section;
}

ReportSection modelSection(const std::vector<LoadedModel>& models) {
    ReportSection section{.heading = "Models"};
    ReportTable table{
        .caption = "Single: whether the model's R_d includes light scattered once, as the reference does.",
        .header = {"model", "single", "evaluated on", "source", "validity"}};
    for (const LoadedModel& loaded : models)
        table.rows.push_back({loaded.model.file.title, loaded.model.file.single_scattering ? "yes" : "no",
                              loaded.evaluator->backend(), loaded.model.file.citation, loaded.model.file.validity});
    section.tables.push_back(std::move(table));
    return section;
}

// Ranks the models that follow the medium; a fixed profile is beside the point on another material.
std::string summaryOf(const std::vector<Judged>& judged, const Subject& subject) {
    std::vector<const Judged*> ranked;
    for (const Judged& row : judged)
        if (row.reads_medium) ranked.push_back(&row);
    if (ranked.empty()) return fmt::format("No model here follows the medium of {}.", subject.name);
    const Judged& best = *ranked.front();
    std::string text = fmt::format(
        "On {}, {} is closest to the reference: its R_d is off by {} of the diffuse reflectance, "
        "averaged over the channels",
        subject.name, best.label, percent(best.error()));
    if (ranked.size() > 1)
        text += fmt::format("; {} is furthest, with {}", ranked.back()->label, percent(ranked.back()->error()));
    return text + ".";
}

std::vector<NamedFigure> figuresOf(const std::vector<PencilCurve>& curves, const PencilReference& reference,
                                   const Subject& subject, double angle_deg) {
    std::vector<NamedFigure> figures;
    constexpr const char* stems[] = {"red", "green", "blue"};
    for (const int c : scatteringChannels(subject.medium)) {
        PencilOptions options;
        options.channel = static_cast<PlotChannel>(c);
        options.material = subject.name;
        options.angle_deg = angle_deg;
        const std::string suffix = subject.medium.channels == 1 ? "" : fmt::format("_{}", stems[c]);
        figures.push_back({"pencil" + suffix, pencilFigure(curves, &reference, options)});
        options.radius_power = 1;
        options.y_scale = AxisScale::linear;
        options.x_scale = AxisScale::square_root;
        figures.push_back({"pencil_times_r" + suffix, pencilFigure(curves, &reference, options)});
        figures.push_back({"error" + suffix, relativeErrorFigure(curves, reference, options)});
    }
    return figures;
}

std::string errorsCsv(const std::vector<Judged>& judged, const Medium& medium) {
    std::string csv =
        "model,channel,weighted_error,near,far,noise,relative_rms,total,reference_total,reference_stderr\n";
    const std::vector<int> channels = scatteringChannels(medium);
    for (const Judged& row : judged)
        for (std::size_t i = 0; i < channels.size(); ++i) {
            const CurveError& e = row.errors[i];
            csv += fmt::format("{},{},{},{},{},{},{},{},{},{}\n", row.id, channelName(medium, channels[i]), e.weighted,
                               e.near, e.far, e.noise, e.relative_rms, row.totals[i], row.true_totals[i],
                               row.true_errors[i]);
        }
    return csv;
}

JobResult runReport(const Job& job, Engine& engine, Observer& observer) {
    const Options options(job);
    const Subject subject = comparableSubjectOf(job, engine);
    const Medium& medium = subject.medium;
    const double angle_deg = options.number("angle_deg");

    std::vector<LoadedModel> models = loadModels(options.names("models"), options.text("backend"), subject, engine);
    ReferenceOptions walk;
    walk.walks = static_cast<std::uint64_t>(options.number("walks"));
    walk.seed = job.seed;
    walk.angle_deg = angle_deg;
    walk.edges_mm = plotEdges(medium, options.number("radii_max"), static_cast<int>(options.number("bins")));
    walk.threads = static_cast<int>(options.number("threads"));
    const ReferenceRun run = runReference(medium, walk, observer);
    if (run.walks() == 0) throw inputError(fmt::format("{} does not scatter in any channel", subject.name));
    const PencilReference reference = run.curve();

    std::vector<PencilCurve> curves;
    for (LoadedModel& model : models)
        curves.push_back(modelCurve(model, angle_deg, curveRadii(walk.edges_mm.back()), walk.edges_mm));
    const std::vector<Judged> judged =
        judge(models, curves, reference, run, pencilBeam(medium.eta, angle_deg).transmittance);
    std::vector<NamedFigure> figures = figuresOf(curves, reference, subject, angle_deg);
    const std::uint64_t albedo_walks = static_cast<std::uint64_t>(options.number("albedo_walks"));
    const AlbedoData albedo = albedoData(medium.eta, 0, options.names("models"), albedo_walks, job.seed,
                                         options.text("backend"), engine, observer);
    figures.push_back(
        {"albedo", albedoFigure(albedo.models, albedo.reference ? &*albedo.reference : nullptr, medium.eta)});

    Report report;
    report.title = fmt::format("{}: models beside the reference", subject.name);
    report.summary = summaryOf(judged, subject);
    report.metadata = {{"program", fmt::format("Searchlight {}", version())}, {"job", jobJson(job)}};
    for (NamedFigure& named : figures) named.figure.metadata = report.metadata;
    ReportSection plots{.heading = "Searchlight profiles"};
    for (const NamedFigure& named : figures) plots.figures.push_back(named.figure);
    report.sections = {errorSection(judged, run), std::move(plots), materialSection(subject),
                       referenceSection(run, job.seed), modelSection(models)};

    const fs::path folder = job.output.empty() ? fs::path("searchlight-report") : fs::path(job.output);
    makeFolder(folder);
    for (const NamedFigure& named : figures)
        for (const std::string& format : figureFormats()) drawFigure(named.figure, folder / (named.stem + format));
    writeFile(folder / "errors.csv", errorsCsv(judged, medium));
    writeFile(folder / "job.json", jobJson(job) + "\n");
    writeFile(folder / "index.html", reportHtml(report));

    Json document = documentJson("searchlight-report/1", job);
    document["material"] = subjectJson(subject);
    document["models"] = Json::array();
    JobResult result;
    result.text = report.summary + "\n\n" +
                  fmt::format("{:<44} {:>12} {:>10} {:>10}\n", "model", "error of R_d", "noise", "total");
    for (const Judged& row : judged) {
        Json channels = Json::array();
        for (std::size_t i = 0; i < row.errors.size(); ++i)
            channels.push_back({{"error", row.errors[i].weighted},
                                {"near", row.errors[i].near},
                                {"far", row.errors[i].far},
                                {"noise", row.errors[i].noise},
                                {"relative_rms", row.errors[i].relative_rms},
                                {"total", row.totals[i]},
                                {"reference_total", row.true_totals[i]},
                                {"reference_stderr", row.true_errors[i]}});
        document["models"].push_back(
            {{"id", row.id}, {"label", row.label}, {"error", row.error()}, {"channels", channels}});
        const auto off = row.totals[0] / row.true_totals[0] - 1;
        result.text += fmt::format("{:<44} {:>12} {:>10} {:>10}\n", row.label, percent(row.error()),
                                   percent(row.errors[0].noise), signedPercent(off));
    }
    document["page"] = (folder / "index.html").string();
    result.text += fmt::format("\nwrote {}\n", (folder / "index.html").string());
    result.json = jsonText(document);
    return result;
}

}  // namespace

Command reportCommand() {
    return {.name = "report",
            .summary = "Write a page: every model beside the reference, on a material",
            .example = "searchlight report --material marble -o out/",
            .options = {option::models(), option::walks(1e6),
                        option::walks(2e5, "albedo_walks", "random walks per point of the albedo figure; 0: none", 0),
                        option::angle(), option::radiiMax(), option::bins(64), option::backend(), option::threads()},
            .uses_material = true,
            .uses_seed = true,
            .writes_folder = true,
            .output = "folder of the page, its figures and its numbers",
            .run = runReport};
}

}  // namespace searchlight
