#include "render/technique.h"

#include <algorithm>

#include "base/error.h"
#include "render/brute_force.h"
#include "render/hierarchical.h"

namespace searchlight {

std::span<const TechniqueEntry> techniques() {
    static const std::vector<TechniqueEntry> entries{
        {.id = "hierarchical",
         .summary = "sum over all points, far ones together, to a stated error",
         .options = {{.name = "error",
                      .min = 1e-4,
                      .max = 0.5,
                      .value = 0.005,
                      .doc = "relative RMSE over the receivers that is asked for"}},
         .directional = true,
         .gl = true,
         .make = makeHierarchical},
        {.id = "brute_force",
         .summary = "sum over all points one by one: any model, slow, what the others are measured against",
         .directional = true,
         .make = makeBruteForce},
    };
    return entries;
}

const TechniqueEntry& findTechnique(std::string_view id) {
    const auto found = std::ranges::find(techniques(), id, &TechniqueEntry::id);
    if (found != techniques().end()) return *found;
    std::vector<std::string> valid;
    for (const TechniqueEntry& entry : techniques()) valid.emplace_back(entry.id);
    throw unknownName(ErrorKind::usage, "technique", id, valid);
}

ParamValues modelParameters(const RenderInput& input) {
    ParamValues values;
    for (const Param& param : input.model->file.parameters) {
        const auto given = input.scene->model.parameters.find(param.name);
        if (given != input.scene->model.parameters.end())
            values[param.name] = parseValue(param, valueText(given->second));
    }
    return values;
}

bool isRadial(const Model& model) { return model.file.radial && model.file.no_wi && model.file.no_wo; }

}  // namespace searchlight
