#include "job/plot/subject.h"

#include <fmt/format.h>

#include "base/error.h"
#include "base/text.h"
#include "model/inversion.h"
#include "scene/materials.h"

namespace searchlight {

namespace {

Rgb spread(const std::vector<double>& list) {
    return list.size() == 1 ? Rgb{list[0], list[0], list[0]} : Rgb{list[0], list[1], list[2]};
}

// (Rdr, ld) is a statement about one model: the scene's.
Subject invertedSubject(const SceneMaterial& material, const SceneModel& scene_model, Engine& engine) {
    for (const auto& [name, list] : {std::pair("Rdr", material.Rdr), {"ld", material.ld}, {"g", material.g}})
        if (list.size() != 1 && list.size() != 3)
            throw inputError(fmt::format("{} of the material holds {} numbers", name, list.size()),
                             "one, or three for R, G, B");
    InversionTarget target;
    target.Rdr = spread(material.Rdr);
    target.ld_mm = spread(material.ld);
    target.eta = material.eta;
    target.g = material.g.front();
    target.channels = material.Rdr.size() == 1 && material.ld.size() == 1 ? 1 : 3;
    const Model model = loadModel(scene_model.id);
    const std::unique_ptr<Evaluator> evaluator = engine.makeEvaluator(model, "auto");
    std::vector<std::string> settings;
    for (const auto& [name, value] : scene_model.parameters) settings.push_back(name + "=" + valueText(value));
    const Inversion inversion = invert(*evaluator, model, parseSettings(model, settings), target);

    Subject subject{.name = fmt::format("Rdr {}, ld {} mm", valueText(material.Rdr), valueText(material.ld)),
                    .id = "custom",
                    .source = fmt::format("Rdr and ld inverted by the {}", model.id),
                    .medium = scaled(inversion.medium, material.scale)};
    for (int c = 0; c < target.channels; ++c)
        if (!inversion.reached[static_cast<std::size_t>(c)])
            subject.notes.push_back(
                fmt::format("Rdr {} cannot be reached by {} at eta {}: it goes from {:.4g} to {:.4g}; "
                            "the nearest, {:.4g}, is used.",
                            target.Rdr[c], model.id, target.eta, inversion.reachable_min[c], inversion.reachable_max[c],
                            inversion.achieved[c]));
    return subject;
}

}  // namespace

Subject subjectOf(const Job& job, Engine& engine) {
    const SceneMaterial& material = job.scene.material;
    if (material.inverted()) return invertedSubject(material, job.scene.model, engine);
    const Material resolved = resolveMaterial(material);
    Subject subject{.name = resolved.name,
                    .id = resolved.id,
                    .source = resolved.source,
                    .medium = resolved.medium,
                    .comparable = resolved.unit_known};
    if (!resolved.note.empty()) subject.notes.push_back(resolved.note);
    if (material.scale != 1) subject.name += fmt::format(", lengths times {}", prettyNumber(material.scale));
    if (material.id.empty()) {
        subject.name = fmt::format("sigma_a {}, sigma_s {}, g {}, eta {}", valueText(material.sigma_a),
                                   valueText(material.sigma_s), valueText(material.g), material.eta);
        subject.source = "as given";
    }
    for (int c = 0; c < subject.medium.channels; ++c)
        if (!subject.medium.scatters(c))
            subject.notes.push_back(
                fmt::format("Channel {} does not scatter: it is not applicable.", channelName(subject.medium, c)));
    return subject;
}

Subject comparableSubjectOf(const Job& job, Engine& engine) {
    Subject subject = subjectOf(job, engine);
    if (!subject.comparable)
        throw inputError(
            fmt::format("the table of {} does not state its unit, so nothing is compared on it", subject.id),
            "give --sigma-a and --sigma-s in 1/mm if you know it");
    return subject;
}

std::string channelName(const Medium& medium, int channel) {
    return medium.channels == 1 ? std::string() : std::string(1, "RGB"[channel]);
}

}  // namespace searchlight
