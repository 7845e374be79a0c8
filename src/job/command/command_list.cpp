// models and materials: what there is.
#include <fmt/format.h>

#include "base/text.h"
#include "job/command_table.h"
#include "job/json.h"
#include "scene/materials.h"

namespace searchlight {

namespace {

JobResult runModels(const Job& job, Engine&, Observer&) {
    Json document = documentJson("searchlight-models/1", job);
    document["models"] = Json::array();
    JobResult result;
    for (const Model& model : shippedModels()) {
        const BssrdfFile& file = model.file;
        Json json;
        json["id"] = model.id;
        json["title"] = file.title;
        json["attributes"] = file.attributes;
        json["parameters"] = Json::array();
        for (const Param& param : file.parameters) json["parameters"].push_back(paramJson(param));
        json["citation"] = file.citation;
        json["validity"] = file.validity;
        json["notes"] = file.notes;
        document["models"].push_back(std::move(json));

        result.text += fmt::format("{:<22} {}\n", model.id, file.title);
        for (const Param& param : file.parameters)
            result.text +=
                fmt::format("{:<22}   --set {}={}  {}\n", "", param.name, valueText(param.value), rangeText(param));
    }
    result.json = jsonText(document);
    return result;
}

JobResult runMaterials(const Job& job, Engine&, Observer&) {
    Json document = documentJson("searchlight-materials/1", job);
    document["materials"] = Json::array();
    JobResult result;
    result.text = fmt::format("{:<34} {:>6}  {:>9} {:>9} {:>9}  {:>9} {:>9} {:>9}  {:>5}\n", "material", "eta",
                              "sigma_a R", "G", "B", "sigma_s R", "G", "B", "g (G)");
    for (const Material& material : materials()) {
        const Subject subject{
            .name = material.name,
            .id = material.id,
            .source = material.source,
            .medium = material.medium,
            .notes = material.note.empty() ? std::vector<std::string>{} : std::vector<std::string>{material.note},
            .comparable = material.unit_known};
        Json json = subjectJson(subject);
        if (!material.unit_known) json["unit"] = nullptr;
        if (material.published_Rd.r >= 0) json["published_Rd"] = valueJson(material.published_Rd);
        document["materials"].push_back(std::move(json));

        const Medium& medium = material.medium;
        result.text += fmt::format(
            "{:<34} {:>6.3g}  {:>9.4g} {:>9.4g} {:>9.4g}  {:>9.4g} {:>9.4g} {:>9.4g}  {:>5.3g}{}\n", material.id,
            medium.eta, medium.sigma_a.r, medium.sigma_a.g, medium.sigma_a.b, medium.sigma_s.r, medium.sigma_s.g,
            medium.sigma_s.b, medium.g.g, material.unit_known ? "" : "  unit unknown: not comparable");
    }
    result.text += "sigma in 1/mm; sigma_s is not reduced, or stands for sigma_s' where g is 0 (--json says which).\n";
    result.json = jsonText(document);
    return result;
}

}  // namespace

Command modelsCommand() {
    return {.name = "models",
            .summary = "List the models, with their parameters",
            .example = "searchlight models",
            .run = runModels};
}

Command materialsCommand() {
    return {.name = "materials",
            .summary = "List the measured materials",
            .example = "searchlight materials",
            .run = runMaterials};
}

}  // namespace searchlight
