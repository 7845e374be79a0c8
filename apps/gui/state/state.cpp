#include "gui/state/state.h"

#include <algorithm>
#include <cassert>

namespace searchlight::gui {

namespace {

// A scene with these parts alone, as text: equal texts are equal parts.
template <class... Members>
std::string textOf(const Scene& scene, Members... members) {
    Scene part;
    ((part.*members = scene.*members), ...);
    return sceneJson(part);
}

std::string textOf(const SceneMaterial& material) {
    Scene part;
    part.material = material;
    return sceneJson(part);
}

bool sameMaterial(const std::optional<SceneMaterial>& a, const std::optional<SceneMaterial>& b) {
    return a.has_value() == b.has_value() && (!a || textOf(*a) == textOf(*b));
}

Change modelDifference(const State& before, const State& after) {
    Change change;
    if (before.models.size() != after.models.size() || before.solo != after.solo) change.add(Part::models);
    for (std::size_t i = 0; i < std::min(before.models.size(), after.models.size()); ++i) {
        const ModelSlot& a = before.models[i];
        const ModelSlot& b = after.models[i];
        if (a.model.id != b.model.id || a.color != b.color || a.visible != b.visible) change.add(Part::models);
        if (a.model.parameters != b.model.parameters) change.add(Part::parameters);
        if (!sameMaterial(a.material, b.material)) change.add(Part::material);
    }
    if (before.active != after.active) change.add(Part::active);
    return change;
}

}  // namespace

Change difference(const State& before, const State& after) {
    Change change = modelDifference(before, after);
    const auto differ = [&](Part part, auto... members) {
        if (textOf(before.scene, members...) != textOf(after.scene, members...)) change.add(part);
    };
    differ(Part::object, &Scene::object, &Scene::scale);
    differ(Part::camera, &Scene::camera);
    differ(Part::lights, &Scene::lights);
    differ(Part::surround, &Scene::ground, &Scene::backdrop, &Scene::coat);
    differ(Part::material, &Scene::material);
    if (before.technique != after.technique || before.technique_options != after.technique_options)
        change.add(Part::technique);
    if (before.options != after.options) change.add(Part::options);
    if (before.seed != after.seed) change.add(Part::seed);
    return change;
}

const ParamValue& optionOf(const State& state, std::string_view section, std::string_view name) {
    const auto known = std::ranges::find(sections(), section, &Section::name);
    assert(known != sections().end());
    static const ParamValues none;
    const auto given = state.options.find(section);
    return valueOf(findParam(known->options, name, "option"), given == state.options.end() ? none : given->second);
}

State defaultState() {
    State state;
    state.scene.object = "statue";
    state.scene.scale = 60;
    state.scene.camera = {.azimuth_deg = 24, .elevation_deg = 10};
    // From behind at the side: what goes through thin parts is what tells the models apart.
    state.scene.lights = {DirectionalLight{.direction = {-0.9, 0.75, -0.8}, .irradiance = {3.2, 3.0, 2.75}},
                          DirectionalLight{.direction = {0.9, 0.7, 0.8}, .irradiance = {0.42, 0.48, 0.6}}};
    state.scene.coat = Coat{.roughness = 0.35};
    for (const char* id : {"better_dipole", "dipole", "normalized_diffusion"})
        state.models.push_back(newSlot(state, id));
    normalise(state);
    return state;
}

Scene sceneOf(const State& state, int model) {
    Scene scene = state.scene;
    const ModelSlot& slot = state.models[static_cast<std::size_t>(model)];
    scene.model = slot.model;
    if (slot.material) scene.material = *slot.material;
    return scene;
}

ModelSlot newSlot(const State& state, std::string id) {
    ModelSlot slot;
    slot.model.id = std::move(id);
    const auto used = [&](int color) {
        return std::ranges::any_of(state.models, [&](const ModelSlot& other) { return other.color == color; });
    };
    while (used(slot.color)) ++slot.color;
    return slot;
}

void normalise(State& state) {
    if (state.models.empty()) state.models.push_back(newSlot(state, state.scene.model.id));
    const int last = static_cast<int>(state.models.size()) - 1;
    state.active = std::clamp(state.active, 0, last);
    if (state.solo > last) state.solo = -1;
    state.scene.model = state.activeModel().model;
}

}  // namespace searchlight::gui
