#include "job/live/try_model.h"

#include <cmath>
#include <filesystem>

#include "model/plane.h"
#include "scene/scene.h"

namespace searchlight {

std::optional<Error> tryModel(std::string_view text, const std::string& path, Engine& engine) {
    try {
        Model model;
        model.id = std::filesystem::path(path).stem().string();
        model.file = parseBssrdf(text, path);
        const Medium medium = resolveMaterial({}).medium;
        {
            const auto evaluator = engine.makeEvaluator(model, "gl");
            evaluator->set(medium, {});
            const Vec3 up{0, 0, 1};
            std::vector<Query> queries;
            for (const double r : {0.1, 1.0, 10.0}) queries.push_back({{}, up, up, {r, 0, 0}, up, up});
            std::vector<Rgb> values(queries.size());
            evaluator->evaluate(queries, values);
            if (model.file.diffuse_reflectance.present()) evaluator->diffuseReflectance({.5, .5, .5});
            for (const Rgb& value : values)
                if (!std::isfinite(value.r) || !std::isfinite(value.g) || !std::isfinite(value.b))
                    throw inputError("the model is not finite on skin1, between r = 0.1 and 10 mm",
                                     "divisions by 0, roots of what is negative")
                        .at(path);
        }
        if (engine.contextLost()) throw deviceError("OpenGL was lost while this model ran");
        return {};
    } catch (const Error& error) {
        if (engine.contextLost()) engine.dropContext();
        return error.at(path);
    }
}

}  // namespace searchlight
