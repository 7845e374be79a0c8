// Evaluates a model, in batches. Native (shipped models, C++ made from their GLSL), GL (any model), measured (a table),
// and sums of these.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>

#include "base/param.h"
#include "model/model.h"
#include "scene/medium.h"

namespace searchlight {

namespace gl {
class Context;
}

/// Not thread-safe: one evaluator, one thread; evaluate() itself may use several.
class Evaluator {
public:
    virtual ~Evaluator() = default;

    /// Sets medium and parameters, and runs the model's init(). Absent parameters have their defaults.
    virtual void set(const Medium& medium, const ParamValues& parameters) = 0;

    /// What the model returns, 1/mm^2 per unit flux that has crossed into the medium: R_d, or Q(wo) for a model
    /// without no_wo (docs/conventions.md). queries and values have the same size. A channel that does not scatter
    /// is left as the model computes it (often NaN).
    virtual void evaluate(std::span<const Query> queries, std::span<Rgb> values) = 0;

    /// DiffuseReflectance(alpha'), or throws a usage Error when the model has none.
    virtual Rgb diffuseReflectance(Rgb alpha_prime) = 0;

    /// "cpu double", "cpu float", "gl llvmpipe (...)".
    virtual std::string backend() const = 0;
};

enum class Precision { single_, double_ };

/// A sum has one where each part has, or is measured.
bool hasNativeEvaluator(const Model& model);

/// Requires hasNativeEvaluator(model).
std::unique_ptr<Evaluator> makeNativeEvaluator(const Model& model, Precision precision = Precision::double_);

/// Compiles the model; throws an input Error with the model's file, line and column when it does not compile.
/// `context` outlives the evaluator.
std::unique_ptr<Evaluator> makeGlEvaluator(const Model& model, gl::Context& context);

/// Requires model.measured.
std::unique_ptr<Evaluator> makeMeasuredEvaluator(const Model& model);

/// Makes the evaluator of one part of a sum.
using PartEvaluator = std::function<std::unique_ptr<Evaluator>(const Model& part)>;

/// Adds what the parts' evaluators return. Requires model.parts. The evaluators above make this for a sum, with tables
/// for its measured parts.
std::unique_ptr<Evaluator> makeSumEvaluator(const Model& model, const PartEvaluator& make);

}  // namespace searchlight
