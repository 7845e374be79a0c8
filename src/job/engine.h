// Owns what outlives a job: the GL context, made when first needed, on the thread that runs jobs.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "base/param.h"
#include "model/evaluator.h"

namespace searchlight {

namespace gl {
class Context;
}

/// A model ready to be evaluated for one medium.
struct LoadedModel {
    Model model;
    ParamValues parameters;
    std::unique_ptr<Evaluator> evaluator;
    Medium medium;  ///< that the evaluator was set to
};

class Engine {
public:
    Engine();
    ~Engine();

    /// Loads `name[:parameter=value]...` and sets its medium. `backend`: "cpu" (a native evaluator, or an Error), "gl",
    /// or "auto" (native where the model ships with one, else GL). `settings` are further "name=value" pairs.
    LoadedModel load(std::string_view model, const std::vector<std::string>& settings, std::string_view backend,
                     const Medium& medium);

    /// An evaluator of that model on that backend.
    std::unique_ptr<Evaluator> makeEvaluator(const Model& model, std::string_view backend);

    gl::Context& context();

    /// There is a context, and it was lost.
    bool contextLost();

    /// The next context() is a new one. What was made in this one must be gone.
    void dropContext();

private:
    std::unique_ptr<gl::Context> context_;
};

/// "Moments=exact" pairs as values of the model's parameters, in a sum also "part.Moments=exact". Throws a usage Error with the nearest names.
ParamValues parseSettings(const Model& model, const std::vector<std::string>& settings);

/// The same for parameters of anything; `what` calls it in messages: "paint.brdf".
ParamValues parseSettings(const std::vector<Param>& parameters, std::string_view what,
                          const std::vector<std::string>& settings);

}  // namespace searchlight
