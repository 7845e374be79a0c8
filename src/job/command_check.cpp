// check: the lint for model writers.
#include <fmt/format.h>

#include <array>

#include "job/command_table.h"
#include "job/json.h"
#include "job/shared_options.h"
#include "validate/check.h"

namespace searchlight {

namespace {

// In the order of CheckResult::Outcome; what failed stands out.
constexpr std::array marks{"pass", "FAIL", "note", "skip"};

JobResult runCheck(const Job& job, Engine& engine, Observer& observer) {
    const Options options(job);
    const Model model = loadModel(options.text("model"));
    const ParamValues parameters = parseSettings(model, options.names("set"));
    const auto factory = [&](const Model& which, std::string_view backend) {
        return engine.makeEvaluator(which, backend);
    };
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
    result.json = document.dump(1);
    return result;
}

}  // namespace

Command checkCommand() {
    return {.name = "check",
            .summary = "Check a model file: does it compile, is it physical, is it portable",
            .example = "searchlight check models/dipole.bssrdf",
            .options =
                {{.name = "model", .type = ParamType::text, .doc = "a .bssrdf file or a model's id", .required = true},
                 option::set()},
            .positional = "model",
            .run = runCheck};
}

}  // namespace searchlight
