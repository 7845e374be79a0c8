#include "render/technique.h"

#include <algorithm>

#include "base/error.h"
#include "model/sum_model.h"
#include "render/brute_force.h"
#include "render/direct.h"
#include "render/hierarchical.h"
#include "render/hybrid.h"
#include "render/local.h"
#include "render/separable.h"
#include "render/texture_space.h"
#include "render/tsm.h"

namespace searchlight {

namespace {

Param normalBeamOption() {
    return {.name = std::string(normal_beam_option),
            .type = ParamType::toggle,
            .value = false,
            .doc = "a model that reads directions is taken for its profile under a normal beam: radial, and fast"};
}

std::vector<Param> with(std::vector<Param> options, Param last) {
    options.push_back(std::move(last));
    return options;
}

}  // namespace

std::span<const TechniqueEntry> techniques() {
    static const std::vector<TechniqueEntry> entries{
        {.id = "hierarchical",
         .summary = "sum over all points, far ones together, to a stated error",
         .options = {{.name = "error",
                      .min = 1e-4,
                      .max = 0.5,
                      .value = 0.005,
                      .doc = "relative RMSE over the receivers that is asked for"},
                     normalBeamOption()},
         .budget = {"error", {0.1, 0.03, 0.01, 0.003, 0.001}},
         .directional = true,
         .gl = true,
         .make = makeHierarchical},
        {.id = "brute_force",
         .summary = "sum over all points one by one: any model, slow, what the others are measured against",
         .options = {normalBeamOption()},
         .budget = {"points", {1'000, 4'000, 16'000}},
         .directional = true,
         .make = makeBruteForce},
        {.id = "direct",
         .summary = "random points of the surface, drawn anew until the noise is gone: any model, no bias, error known",
         .options = with(directOptions(), normalBeamOption()),
         .budget = {"spp", {1, 4, 16, 64, 256}},
         .directional = true,
         .light_at = LightPlace::own,
         .make = makeDirect},
        {.id = "separable",
         .summary = "a separable kernel blurs the light of the picture's pixels, as games do",
         .options = with(separableOptions(), normalBeamOption()),
         .budget = {"taps", {7, 11, 17, 25, 41}},
         .light_at = LightPlace::visible,
         .gl = true,
         .make = makeSeparable},
        {.id = "texture-space",
         .summary = "few samples of the light, drawn in an atlas of the surface, serve all receivers",
         .options = with(textureSpaceOptions(), normalBeamOption()),
         .budget = {"samples", {100, 400, 1'600, 6'400, 25'600}},
         .directional = true,
         .light_at = LightPlace::own,
         .gl = true,
         .make = makeTextureSpace},
        {.id = "local",
         .summary = "samples of the tangent plane, projected onto what the eye sees; points where it does not see",
         .options = with(localOptions(), normalBeamOption()),
         .budget = {"samples", {16, 64, 256, 1'024}},
         .light_at = LightPlace::visible,
         .make = makeLocal},
        {.id = "tsm",
         .summary = "a filter of rings around each receiver in what the lights see",
         .options = with(lightViewOptions(), normalBeamOption()),
         .budget = {"local_samples", {51, 101, 201, 401, 1'601}},
         .light_at = LightPlace::own,
         .make = makeTsm},
        {.id = "hybrid",
         .summary = "texture space for what comes from far, samples around each receiver for what comes from near",
         .options = with(hybridOptions(), normalBeamOption()),
         .budget = {"samples", {100, 400, 900, 3'600}},
         .light_at = LightPlace::own,
         .make = makeHybrid},
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
    for (const auto& [given, value] : input.scene->model.parameters) {
        const std::string name = parameterName(*input.model, given);
        const auto param = std::ranges::find(input.model->file.parameters, name, &Param::name);
        if (param != input.model->file.parameters.end()) values[name] = parseValue(*param, valueText(value));
    }
    return values;
}

bool isRadial(const Model& model) { return model.file.radial && model.file.no_wi && model.file.no_wo; }

}  // namespace searchlight
