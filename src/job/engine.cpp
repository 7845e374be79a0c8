#include "job/engine.h"

#include <fmt/format.h>

#include "base/error.h"
#include "base/text.h"
#include "gl/context.h"
#include "model/sum_model.h"

namespace searchlight {

Engine::Engine() = default;
Engine::~Engine() = default;

gl::Context& Engine::context() {
    if (!context_) context_ = std::make_unique<gl::Context>();
    return *context_;
}

bool Engine::contextLost() { return context_ && context_->lost(); }

void Engine::dropContext() { context_.reset(); }

std::unique_ptr<Evaluator> Engine::makeEvaluator(const Model& model, std::string_view backend) {
    if (!model.parts.empty())
        return makeSumEvaluator(model, [&](const Model& part) { return makeEvaluator(part, backend); });
    if (model.measured) return makeMeasuredEvaluator(model);
    const bool native = hasNativeEvaluator(model);
    if (backend == "cpu" && !native)
        throw usageError(
            fmt::format("model '{}' has no native evaluator: only shipped models are compiled for the CPU", model.id),
            "use --backend gl or auto");
    if (backend == "gl" || !native) return makeGlEvaluator(model, context());
    return makeNativeEvaluator(model);
}

LoadedModel Engine::load(std::string_view name, const std::vector<std::string>& settings, std::string_view backend,
                         const Medium& medium) {
    LoadedModel loaded;
    // "better_dipole:Moments=exact" carries its own settings, so that one list can hold variants of a model.
    const std::vector<std::string_view> parts = split(name, ':');
    std::vector<std::string> all = settings;
    all.insert(all.end(), parts.begin() + 1, parts.end());
    loaded.model = loadModel(parts.front());
    loaded.parameters = parseSettings(loaded.model, all);
    loaded.evaluator = makeEvaluator(loaded.model, backend);
    loaded.evaluator->set(medium, loaded.parameters);
    loaded.medium = medium;
    return loaded;
}

namespace {

// `name_of` makes the name of a parameter of what was given.
template <class NameOf>
ParamValues parsePairs(const std::vector<Param>& parameters, std::string_view what,
                       const std::vector<std::string>& settings, const NameOf& name_of) {
    ParamValues values;
    // "Tint=1,0.5,0.2" was cut at its commas with the rest of the list.
    std::vector<std::string> whole;
    for (const std::string& part : settings) {
        if (part.find('=') == std::string::npos && !whole.empty())
            whole.back() += "," + part;
        else
            whole.push_back(part);
    }
    for (const std::string& setting : whole) {
        const std::size_t equals = setting.find('=');
        if (equals == std::string::npos)
            throw usageError(fmt::format("'{}' is no setting", setting), "expected name=value");
        const std::string name = name_of(trim(std::string_view(setting).substr(0, equals)));
        const Param& param = findParam(parameters, name, fmt::format("parameter of {}", what));
        values[name] = parseValue(param, std::string_view(setting).substr(equals + 1));
    }
    return values;
}

}  // namespace

ParamValues parseSettings(const Model& model, const std::vector<std::string>& settings) {
    return parsePairs(model.file.parameters, model.id, settings,
                      [&](std::string_view given) { return parameterName(model, given); });
}

ParamValues parseSettings(const std::vector<Param>& parameters, std::string_view what,
                          const std::vector<std::string>& settings) {
    return parsePairs(parameters, what, settings, [](std::string_view given) { return std::string(given); });
}

}  // namespace searchlight
