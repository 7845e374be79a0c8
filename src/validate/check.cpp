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
    {{"format", "can the file be read?"}, checkFormat},
    {{"compiles", "does OpenGL take its GLSL?"}, checkCompiles},
    {{"portable", "could its GLSL be compiled for the CPU as well?"}, checkPortable},
    {{"finite", "is every value a finite number, away from the point of entry?"}, checkFinite},
    {{"non-negative", "is no value below zero?"}, checkNonNegative},
    {{"parameter ends", "do values stay finite where a parameter is at an end of its range?"}, checkParameterEnds},
    {{"energy", "does no more light leave than has entered?"}, checkEnergy},
    {{"closed form", "is DiffuseReflectance the integral of the profile?"}, checkClosedForm},
    {{"scaling", "in a medium s times thinner, is R_d(s r) the same as R_d(r) / s^2?"}, checkScaling},
    {{"radial", "if claimed: does nothing but the distance of the two points matter?"}, checkRadial},
    {{"no_wi", "if claimed: does the direction of incidence not matter?"}, checkNoWi},
    {{"no_wo", "if claimed: does the direction of exit not matter?"}, checkNoWo},
    {{"reciprocal", "if claimed: is it the same with both ends exchanged?"}, checkReciprocal},
    {{"backends agree", "do OpenGL and native code return the same?"}, checkBackendsAgree},
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
