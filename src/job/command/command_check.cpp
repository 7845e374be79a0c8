// check: the lint for model writers.
#include <fmt/format.h>

#include <array>

#include "base/text.h"
#include "job/command_table.h"
#include "job/json.h"
#include "job/shared_options.h"
#include "validate/check.h"
#include "validate/model_sanity.h"

namespace searchlight {

namespace {

// In the order of CheckResult::Outcome; what failed stands out.
constexpr std::array marks{"pass", "FAIL", "note", "skip"};

Json totalJson(const SanityTotal& total) {
    return {{"eta", total.eta},
            {"g", total.g},
            {"albedo", total.albedo},
            {"angle_deg", total.angle_deg},
            {"total", total.total}};
}

// The numbers over the grid, in place of verdicts.
JobResult gridResult(const Model& model, const ModelSanity& sanity, const Job& job) {
    Json document = documentJson("searchlight-check-grid/1", job);
    document["model"] = model.id;
    document["title"] = model.file.title;
    document["attributes"] = model.file.attributes;
    document["totals"] = Json::array();
    document["above"] = Json::array();
    for (const SanityTotal& total : sanity.totals) document["totals"].push_back(totalJson(total));
    for (const SanityTotal& total : sanity.above) document["above"].push_back(totalJson(total));
    document["most"] = totalJson(sanity.most);
    document["negative"] = {{"share", sanity.least_share}, {"where", sanity.least_where}};
    document["reciprocal"] = {{"difference", sanity.reciprocal}, {"where", sanity.reciprocal_where}};
    document["scaling"] = sanity.scales ? Json{{"error", sanity.scaling}, {"where", sanity.scaling_where}} : Json();

    JobResult result;
    result.json = jsonText(document);
    const SanityTotal& most = sanity.most;
    const auto where = [](const std::string& place) { return place.empty() ? "" : ", at " + place; };
    result.text = fmt::format(
        "{}, over {} media\n  largest total  {} of what entered, at alpha' {}, IOR {}, g {}, {} deg; above 1 at {} "
        "points\n  least value    {} of the largest at that medium, times r^2{}\n  reciprocal     there and back "
        "differ by {}{}\n  scaling        {}\n",
        model.file.title, sanity.totals.size(), prettyNumber(most.total), prettyNumber(most.albedo),
        prettyNumber(most.eta), prettyNumber(most.g), prettyNumber(most.angle_deg), sanity.above.size(),
        prettyNumber(sanity.least_share, 2), where(sanity.least_where), prettyNumber(sanity.reciprocal, 2),
        where(sanity.reciprocal_where),
        sanity.scales ? fmt::format("off by {}{}", prettyNumber(sanity.scaling, 2), where(sanity.scaling_where))
                      : "does not read the medium");
    return result;
}

JobResult runCheck(const Job& job, Engine& engine, Observer& observer) {
    const Options options(job);
    const Model model = loadModel(options.text("model"));
    const ParamValues parameters = parseSettings(model, options.names("set"));
    const auto factory = [&](const Model& which, std::string_view backend) {
        return engine.makeEvaluator(which, backend);
    };
    if (options.toggle("grid")) return gridResult(model, modelSanity(model, parameters, factory, observer), job);
    const std::vector<CheckResult> checks = checkModel(model, parameters, factory, observer);

    JobResult result;
    Json document = documentJson("searchlight-check/1", job);
    document["model"] = model.id;
    document["title"] = model.file.title;
    document["checks"] = Json::array();
    result.text = fmt::format("{} ({})\n", model.file.title, options.text("model"));
    std::array<int, marks.size()> counts{};
    const std::vector<CheckInfo> list = checkList();
    for (std::size_t i = 0; i < checks.size(); ++i) {
        const CheckResult& check = checks[i];
        const auto outcome = static_cast<std::size_t>(check.outcome);
        document["checks"].push_back({{"name", check.name},
                                      {"asks", list[i].asks},
                                      {"outcome", outcomeName(check.outcome)},
                                      {"detail", check.detail}});
        result.text += fmt::format("  {}  {:<15} {}\n", marks[outcome], check.name, check.detail);
        ++counts[outcome];
    }
    const auto [passed, failed, reported, skipped] = counts;
    result.passed = failed == 0;
    result.text += fmt::format("{} passed, {} failed, {} reported, {} skipped\n", passed, failed, reported, skipped);
    document["passed"] = passed;
    document["failed"] = failed;
    document["reported"] = reported;
    document["skipped"] = skipped;
    result.json = jsonText(document);
    return result;
}

}  // namespace

Command checkCommand() {
    return {.name = "check",
            .summary = "Check a model file: does it compile, is it physical, is it portable",
            .example = "searchlight check models/dipole.bssrdf",
            .options =
                {{.name = "model", .type = ParamType::text, .doc = "a .bssrdf file or a model's id", .required = true},
                 option::set(),
                 {.name = "grid",
                  .type = ParamType::toggle,
                  .value = false,
                  .doc = "in place of verdicts: energy, negative values, reciprocity and scaling over 144 media"}},
            .positional = "model",
            .run = runCheck};
}

}  // namespace searchlight
