// The lint for model writers: what a model claims, held against what it computes.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/observer.h"
#include "model/evaluator.h"

namespace searchlight {

struct CheckResult {
    enum class Outcome {
        passed,
        failed,
        reported,  ///< no fault, but something that users of the model should know
        skipped    ///< not applicable, or not possible on this machine
    };
    std::string name;  ///< of a row of checkList()
    Outcome outcome = Outcome::passed;
    std::string detail;  ///< the number, and where it happened
};

/// "passed", "failed", "reported", "skipped".
std::string_view outcomeName(CheckResult::Outcome outcome);

struct CheckInfo {
    std::string_view name;
    std::string_view asks;  ///< the question, one line
};

/// What checkModel looks at, in that order.
std::vector<CheckInfo> checkList();

/// Makes an evaluator on "cpu" or "gl". May throw a device Error, and an input Error for GLSL that does not compile.
using EvaluatorFactory = std::function<std::unique_ptr<Evaluator>(const Model& model, std::string_view backend)>;

/// One result per row of checkList(). Sampling is deterministic. Throws what the model's text is to blame for, with
/// file, line and column: GLSL that does not compile, a loop that does not end; a device Error when the model needs GL
/// and there is none; interruptedError() when the observer cancels.
std::vector<CheckResult> checkModel(const Model& model, const ParamValues& parameters, const EvaluatorFactory& factory,
                                    Observer& observer);

}  // namespace searchlight
