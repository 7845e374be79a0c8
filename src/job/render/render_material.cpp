#include "job/render/render_material.h"

#include <fmt/format.h>

namespace searchlight {

MaterialSource materialSource(Engine& engine, std::string backend, Subject* subject) {
    return [&engine, backend = std::move(backend), subject](const Scene& scene) {
        Job job;
        job.scene = scene;
        Subject resolved = subjectOf(job, engine);
        if (!resolved.comparable)
            resolved.notes.emplace_back("The material's table does not state its unit: it was taken as 1/mm.");
        std::vector<std::string> settings;
        for (const auto& [name, value] : scene.model.parameters)
            settings.push_back(fmt::format("{}={}", name, valueText(value)));
        LoadedModel loaded = engine.load(scene.model.id, settings, backend, resolved.medium);
        RenderMaterial material{std::move(loaded.model), resolved.medium, std::move(loaded.evaluator)};
        if (subject) *subject = std::move(resolved);
        return material;
    };
}

}  // namespace searchlight
