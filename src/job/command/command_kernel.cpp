// kernel: separable kernels of a material, with their errors, as tables that shaders take.
#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "base/files.h"
#include "base/text.h"
#include "base/version.h"
#include "job/command_table.h"
#include "job/kernel/kernel_export.h"
#include "job/kernel/kernel_judged.h"
#include "job/kernel/kernel_page.h"
#include "job/kernel/kernel_truth.h"
#include "job/shared_options.h"
#include "kernel/kernel_text.h"

namespace searchlight {

namespace {

MethodOptions methodOf(const Options& options) {
    MethodOptions method{.method = options.text("method"),
                         .taps = static_cast<int>(options.number("taps")),
                         .placed = options.text("placement") == "placed",
                         .rest = options.number("rest"),
                         .rank = static_cast<int>(options.number("rank")),
                         .guided = {.k = options.number("k"), .b = options.number("b")},
                         .count = static_cast<int>(options.number("count")),
                         .preset = options.text("preset")};
    if (options.toggle("thesis")) method.guided.soft = kThesisSoftness;
    if (options.text("fit") == "kernel_space") method.measure = GaussianMeasure::kernel_space;
    if (options.toggle("thesis")) method.measure = GaussianMeasure::kernel_space_any_mass;
    return method;
}

JudgeOptions judgeOf(const Options& options, const KernelTruth& truth) {
    JudgeOptions judge{.size = static_cast<int>(options.number("size")), .side_mm = options.number("side")};
    if (judge.size % 2 != 0) throw usageError("pictures have an even number of pixels per side", "--size 128");
    if (options.toggle("thesis")) judge.grid = thesisGrid(truth.shortest_mfp_mm, truth.longest_mfp_mm);
    return judge;
}

Json truthJson(const KernelTruth& truth, const Judge& judge) {
    const double extent = judge.cells().edges.back();
    const Rgb inside = truth.truth.encircled(extent), total = truth.truth.total();
    return {{"from", truth.label},
            {"total", {total.r, total.g, total.b}},
            {"cell_mm", 2 * judge.cells().edges[1]},
            {"extent_mm", extent},
            {"energy_beyond", {1 - inside.r, 1 - inside.g, 1 - inside.b}},
            {"tail_of_profile", truth.truth.tail()},
            {"pixel_mm", judge.pixel()}};
}

JobResult runCheck(const Job& job, const Options& options, const Subject& subject, const KernelTruth& truth,
                   const Judge& judge) {
    const std::string path = options.text("check");
    const std::vector<KernelTable> tables = parseKernelTables(readFile(path), path);
    JobResult result;
    Json document = documentJson("searchlight-kernel/1", job);
    document["material"] = subjectJson(subject);
    document["truth"] = truthJson(truth, judge);
    document["kernels"] = Json::array();
    std::size_t next = 0;
    for (Taps& taps : kernelsOfTables(tables)) {
        const KernelTable& first = tables[next];
        std::vector<std::string> faults;
        for (std::size_t t = 0; t < taps.rank(); ++t)
            for (const std::string& fault : tables[next + t].faults)
                faults.push_back(fmt::format("{}:{}: {}", path, tables[next + t].line, fault));
        next += taps.rank();
        const double width = judge.bestWidth(taps);
        Taps scaled = taps;
        for (TapTerm& term : scaled.terms)
            for (double& offset : term.offsets_mm) offset *= width;
        const std::string name = first.name.empty() ? fmt::format("table at line {}", first.line) : first.name;
        const JudgedKernel as_is = judgeKernel({.name = name, .taps = std::move(taps)}, judge, true, 0);
        const JudgedKernel best = judgeKernel({.name = name + " *", .taps = std::move(scaled)}, judge, true, 0);
        result.text += fmt::format(
            "{}, line {}: {} taps, {}; offsets taken as mm\n", name, first.line, first.term.offsets_mm.size(),
            faults.empty() ? std::string("no faults in itself") : fmt::format("faults: {}", faults.size()));
        for (const std::string& fault : faults) result.text += fmt::format("  {}\n", fault);
        result.text += judgedText({as_is, best});
        result.text += fmt::format("* with its width times {:.3g}, where it is nearest to {}\n\n", width, subject.name);
        Json json{{"line", first.line},
                  {"one_sided", first.one_sided},
                  {"faults", faults},
                  {"best_width", width},
                  {"error_at_best_width", judgedJson(best)["error"]}};
        json.update(judgedJson(as_is));
        json["name"] = name;
        document["kernels"].push_back(std::move(json));
        result.passed = result.passed && faults.empty();
    }
    result.json = jsonText(document);
    return result;
}

JobResult runAll(const Job& job, const Options& options, const Subject& subject, const KernelTruth& truth,
                 const Judge& judge, Observer& observer) {
    std::vector<JudgedKernel> kernels;
    const std::vector<MethodOptions> all = allMethods(static_cast<int>(options.number("taps")));
    for (const MethodOptions& method : all) {
        kernels.push_back(makeAndJudge(truth.truth, judge, method, true, static_cast<int>(options.number("threads"))));
        observer.progress("kernels", kernels.size(), all.size(), "kernels");
        if (observer.cancelled()) throw interruptedError();
    }
    JobResult result;
    result.text = fmt::format("Kernels of {}, {} taps, against {}\n\n{}", subject.name,
                              static_cast<int>(options.number("taps")), truth.label, judgedText(kernels));
    Json document = documentJson("searchlight-kernel/1", job);
    document["material"] = subjectJson(subject);
    document["truth"] = truthJson(truth, judge);
    document["kernels"] = Json::array();
    for (const JudgedKernel& kernel : kernels) document["kernels"].push_back(judgedJson(kernel));
    result.json = jsonText(document);
    if (job.output.empty()) return result;
    if (job.output.ends_with(".html")) {
        Report report = kernelPage(subject, truth, judge, kernels);
        report.metadata = {{"program", fmt::format("Searchlight {}", version())}, {"job", jobJson(job)}};
        writeFile(job.output, reportHtml(report));
    } else
        writeFile(job.output, job.output.ends_with(".json") ? result.json + "\n" : result.text);
    result.text += fmt::format("\nwrote {}\n", job.output);
    return result;
}

JobResult runKernel(const Job& job, Engine& engine, Observer& observer) {
    const Options options(job);
    const Subject subject = comparableSubjectOf(job, engine);
    const KernelTruth truth = kernelTruth(subject,
                                          {.model = options.text("model"),
                                           .set = options.text("set"),
                                           .backend = options.text("backend"),
                                           .walks = static_cast<std::uint64_t>(options.number("walks")),
                                           .seed = job.seed,
                                           .threads = static_cast<int>(options.number("threads")),
                                           .bins_of_grid = options.toggle("thesis")},
                                          engine, observer);
    const Judge judge(truth.truth, judgeOf(options, truth));
    if (!options.text("check").empty()) return runCheck(job, options, subject, truth, judge);
    if (options.toggle("all")) return runAll(job, options, subject, truth, judge, observer);

    const JudgedKernel judged =
        makeAndJudge(truth.truth, judge, methodOf(options), true, static_cast<int>(options.number("threads")));
    JobResult result;
    Json document = documentJson("searchlight-kernel/1", job);
    document["material"] = subjectJson(subject);
    document["truth"] = truthJson(truth, judge);
    document["method"] = options.text("method");
    document.update(judgedJson(judged));
    result.json = jsonText(document);
    const std::string format = options.text("export");
    const std::string shown = exportedKernel(format.empty() ? "hlsl" : format, judged, subject, truth);
    if (format.empty())
        result.text = fmt::format("{} of {}, against {}\n\n{}\n{}", judged.made.name, subject.name, truth.label,
                                  judgedText({judged}), shown);
    else
        result.text = shown;
    if (!job.output.empty())
        writeFile(job.output, job.output.ends_with(".json") && format.empty() ? result.json : shown);
    return result;
}

std::vector<std::string> methodNames() {
    std::vector<std::string> names;
    for (const Method& method : methods()) names.emplace_back(method.name);
    return names;
}

}  // namespace

Command kernelCommand() {
    const auto number = [](std::string name, double value, double min, double max, std::string doc,
                           std::string unit = {}, ParamType type = ParamType::number) {
        return Param{.name = std::move(name),
                     .type = type,
                     .unit = std::move(unit),
                     .min = min,
                     .max = max,
                     .value = value,
                     .doc = std::move(doc)};
    };
    const auto whole = [&](std::string name, double value, double min, double max, std::string doc) {
        return number(std::move(name), value, min, max, std::move(doc), {}, ParamType::integer);
    };
    const auto toggle = [](std::string name, std::string doc) {
        return Param{.name = std::move(name), .type = ParamType::toggle, .value = false, .doc = std::move(doc)};
    };
    Param model = option::model();
    model.value = std::string("reference");
    model.doc = "what is to be matched: reference (walks), a model's id, a .bssrdf file or a measured .csv profile";
    return {.name = "kernel",
            .summary = "Make separable kernels of a material, judge them, and write them for a shader",
            .example = "searchlight kernel --material skin1 --method preintegrated --taps 17 --export hlsl",
            .options = {{.name = "method",
                         .type = ParamType::choice,
                         .value = std::string("preintegrated"),
                         .choices = methodNames(),
                         .doc = "how the kernel is found (docs/kernels.md)"},
                        whole("taps", 17, 3, 101, "per pass: an odd number, 7 to 41 in practice"),
                        {.name = "placement",
                         .type = ParamType::choice,
                         .value = std::string("quadratic"),
                         .choices = {"quadratic", "placed"},
                         .doc = "of the taps: dense at the middle, or where the line is best kept"},
                        number("rest", 0.01, 1e-6, 0.5, "part of a line beyond the outermost quadratic tap"),
                        whole("rank", 1, 1, 12, "pairs of passes, of svd and optimised"),
                        number("k", 1, 0, 8, "guided: 0 favours the middle, 2 the far field"),
                        number("b", 0, 0, 1e6, "guided: above 0, less weight near the axes"),
                        whole("count", 4, 1, most_gaussian_terms, "gaussians: how many"),
                        {.name = "fit",
                         .type = ParamType::choice,
                         .value = std::string("pictures"),
                         .choices = {"pictures", "kernel_space"},
                         .doc = "gaussians: where the fit is near"},
                        {.name = "preset",
                         .type = ParamType::text,
                         .value = std::string(),
                         .doc = "gaussians: skin6, skin4, marble4, marble_green; manual: a material of Table A.1"},
                        toggle("thesis", "grid, bins and soft constraint of Freude 2014"),
                        toggle("all", "every method, with its errors"),
                        {.name = "check",
                         .type = ParamType::path,
                         .value = std::string(),
                         .doc = "judge the tables of this file (HLSL, GLSL, C, Godot, JSON, lines of numbers) instead"},
                        {.name = "export",
                         .type = ParamType::text,
                         .value = std::string(),
                         .doc = "hlsl, glsl, c, json, godot, unreal or unity"},
                        model,
                        option::set(),
                        whole("size", 128, 16, 1024, "of the pictures to judge by, pixels"),
                        number("side", 0, 0, 1e6, "of the same; 0: 16 half-energy radii of the middle channel", "mm"),
                        option::walks(1e6),
                        option::backend(),
                        option::threads()},
            .uses_material = true,
            .uses_seed = true,
            .output = "the exported text; with --all a page (.html), .json or .txt",
            .run = runKernel};
}

}  // namespace searchlight
