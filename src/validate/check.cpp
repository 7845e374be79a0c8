#include "validate/check.h"

#include <fmt/format.h>

#include "base/error.h"
#include "validate/check_bench.h"

namespace searchlight {

namespace {

struct Check {
    CheckInfo info;
    Finding (*run)(CheckBench& bench);
};

constexpr Check checks[] = {
    {{"format", "the file can be read"}, checkFormat},
    {{"compiles", "OpenGL takes its GLSL"}, checkCompiles},
    {{"portable", "its GLSL is in the subset that can also be compiled for the CPU"}, checkPortable},
    {{"finite", "no value is NaN or infinite away from the point of entry"}, checkFinite},
    {{"non-negative", "no value is below zero"}, checkNonNegative},
    {{"parameter ends", "values stay finite where a parameter is at an end of its range"}, checkParameterEnds},
    {{"energy", "no more light leaves than has entered"}, checkEnergy},
    {{"closed form", "DiffuseReflectance is the integral of the profile"}, checkClosedForm},
    {{"scaling", "R_d(s r) in a medium s times thinner is R_d(r) / s^2"}, checkScaling},
    {{"radial", "only the distance of the two points matters, if claimed"}, checkRadial},
    {{"no_wi", "the direction of incidence does not matter, if claimed"}, checkNoWi},
    {{"no_wo", "the direction of exit does not matter, if claimed"}, checkNoWo},
    {{"reciprocal", "light may be followed backwards, if claimed"}, checkReciprocal},
    {{"backends agree", "OpenGL and native code return the same"}, checkBackendsAgree},
};

Finding runCheck(const Check& check, CheckBench& bench) {
    try {
        return check.run(bench);
    } catch (const Error& error) {
        // What has a line in the model's text ends the run; what a check could not compute is its result.
        if (error.kind != ErrorKind::input || error.line > 0) throw;
        return failed(error.what());
    }
}

}  // namespace

std::string_view outcomeName(CheckResult::Outcome outcome) {
    switch (outcome) {
        case CheckResult::Outcome::passed: return "passed";
        case CheckResult::Outcome::failed: return "failed";
        case CheckResult::Outcome::reported: return "reported";
        case CheckResult::Outcome::skipped: return "skipped";
    }
    return {};
}

std::vector<CheckInfo> checkList() {
    std::vector<CheckInfo> list;
    for (const Check& check : checks) list.push_back(check.info);
    return list;
}

std::vector<CheckResult> checkModel(const Model& model, const ParamValues& parameters, const EvaluatorFactory& factory,
                                    Observer& observer) {
    CheckBench bench(model, parameters, factory, observer);
    std::vector<CheckResult> results;
    for (const Check& check : checks) {
        bench.pollCancelled();
        const Finding finding = runCheck(check, bench);
        results.push_back({std::string(check.info.name), finding.outcome, finding.detail});
        observer.progress("check", results.size(), std::size(checks), "checks");
    }
    return results;
}

}  // namespace searchlight
