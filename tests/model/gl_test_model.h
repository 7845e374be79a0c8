// What the tests of the GL evaluator share.
#pragma once

#include <cmath>
#include <string_view>
#include <vector>

#include "gl/context.h"
#include "model/evaluator.h"

namespace searchlight {

inline Model modelOf(std::string_view text, std::string_view path = "test.bssrdf") {
    Model model;
    model.id = "test";
    model.file = parseBssrdf(text, path);
    return model;
}

/// Light enters at the origin from straight above and leaves straight up at (r, 0, 0).
inline Query queryAt(double r_mm) {
    const Vec3 up{0, 0, 1};
    return {{0, 0, 0}, up, up, {r_mm, 0, 0}, up, up};
}

/// `count` values from first to last, in equal ratios.
inline std::vector<double> ratioSteps(double first, double last, int count) {
    std::vector<double> values;
    for (int i = 0; i < count; ++i) values.push_back(first * std::pow(last / first, i / (count - 1.0)));
    return values;
}

inline Rgb evaluateAt(Evaluator& evaluator, const Query& query) {
    Rgb value;
    evaluator.evaluate({&query, 1}, {&value, 1});
    return value;
}

/// Compiles the text, sets a medium without surprises, and evaluates once, 1 mm away.
inline Rgb evaluateText(std::string_view text, gl::Context& context, const ParamValues& parameters = {}) {
    const Model model = modelOf(text);
    const auto evaluator = makeGlEvaluator(model, context);
    evaluator->set({{0.1, 0.2, 0.3}, {1, 2, 3}, {0, 0.5, 0.9}, 1.5}, parameters);
    return evaluateAt(*evaluator, queryAt(1));
}

}  // namespace searchlight
