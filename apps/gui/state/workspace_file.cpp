// A workspace is a render job, so that the command line runs it; what only the window knows stands under "window".
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "base/error.h"
#include "gui/state/state.h"
#include "job/command.h"
#include "job/json.h"
#include "render/technique.h"
#include "scene/json_text.h"

namespace searchlight::gui {

namespace {

// More than anybody looks at; a file with more is a mistake or a trap.
constexpr int most_models = 64;

Json slotJson(const ModelSlot& slot) {
    Scene scene;
    scene.model = slot.model;
    if (slot.material) scene.material = *slot.material;
    const Json whole = Json::parse(sceneJson(scene));
    Json json;
    json["scene"]["model"] = whole["model"];
    if (slot.material) json["scene"]["material"] = whole["material"];
    json["color"] = slot.color;
    json["visible"] = slot.visible;
    return json;
}

Json windowJson(const State& state) {
    Json json;
    for (const ModelSlot& slot : state.models) json["models"].push_back(slotJson(slot));
    json["active"] = state.active;
    json["solo"] = state.solo;
    if (state.activeModel().material) {
        Scene shared;
        shared.material = state.scene.material;
        json["scene"]["material"] = Json::parse(sceneJson(shared))["material"];
    }
    json["options"] = Json::object();
    for (const auto& [section, values] : state.options)
        for (const auto& [name, value] : values) json["options"][section][name] = valueJson(value);
    return json;
}

class WindowReader {
public:
    explicit WindowReader(const JsonText& text) : text_(text), json_(text.root().at("window")) {}

    void read(State& state) const {
        onlyKeys(json_, "/window", {"models", "active", "solo", "scene", "options"});
        if (json_.contains("models")) readModels(state);
        const int count = static_cast<int>(state.models.size());
        state.active = index("active", 0, 0, count - 1);
        state.solo = index("solo", -1, -1, count - 1);
        if (json_.contains("scene")) state.scene.material = readScene(text_, "/window/scene").material;
        if (json_.contains("options")) readOptions(state);
    }

private:
    void onlyKeys(const nlohmann::json& object, const std::string& pointer,
                  const std::vector<std::string>& keys) const {
        if (!object.is_object()) throw text_.error(pointer, "expected an object");
        for (const auto& [key, value] : object.items())
            if (std::ranges::find(keys, key) == keys.end()) {
                const Error unknown = unknownName(ErrorKind::input, "key", key, keys);
                throw text_.errorAtKey(pointer + pointerStep(key), unknown.message, unknown.hint);
            }
    }

    int index(const char* key, int standard, int least, int most) const {
        if (!json_.contains(key)) return standard;
        const std::string pointer = std::string("/window/") + key;
        const Param param{.name = key, .type = ParamType::integer, .min = -1, .max = most_models, .value = 0.0};
        const int value = static_cast<int>(std::get<double>(text_.value(pointer, json_.at(key), param)));
        if (value < least || value > most)
            throw text_.error(pointer, fmt::format("expected an index from {} to {}", least, most));
        return value;
    }

    void readModels(State& state) const {
        const nlohmann::json& list = json_.at("models");
        if (!list.is_array() || list.empty() || list.size() > most_models)
            throw text_.error("/window/models", fmt::format("expected a list of 1 to {} models", most_models));
        state.models.clear();
        for (std::size_t i = 0; i < list.size(); ++i) {
            const std::string pointer = fmt::format("/window/models/{}", i);
            onlyKeys(list[i], pointer, {"scene", "color", "visible"});
            if (!list[i].contains("scene")) throw text_.error(pointer, "no scene", "such as {\"model\": {...}}");
            const Scene scene = readScene(text_, pointer + "/scene");
            ModelSlot slot = newSlot(state, {});
            slot.model = scene.model;
            if (list[i].at("scene").contains("material")) slot.material = scene.material;
            if (const auto color = list[i].find("color"); color != list[i].end()) {
                const Param param{
                    .name = "color", .type = ParamType::integer, .min = 0, .max = most_models, .value = 0.0};
                slot.color = static_cast<int>(std::get<double>(text_.value(pointer + "/color", *color, param)));
            }
            if (const auto visible = list[i].find("visible"); visible != list[i].end()) {
                const Param param{.name = "visible", .type = ParamType::toggle, .value = true};
                slot.visible = std::get<bool>(text_.value(pointer + "/visible", *visible, param));
            }
            state.models.push_back(std::move(slot));
        }
    }

    void readOptions(State& state) const {
        const nlohmann::json& options = json_.at("options");
        std::vector<std::string> names;
        for (const Section& section : sections()) names.push_back(section.name);
        onlyKeys(options, "/window/options", names);
        for (const Section& section : sections()) {
            const auto given = options.find(section.name);
            if (given == options.end()) continue;
            const std::string pointer = "/window/options" + pointerStep(section.name);
            std::vector<std::string> keys;
            for (const Param& param : section.options) keys.push_back(param.name);
            onlyKeys(*given, pointer, keys);
            for (const auto& [name, value] : given->items())
                state.options[section.name][name] =
                    text_.value(pointer + pointerStep(name), value, findParam(section.options, name, "option"));
        }
    }

    const JsonText& text_;
    const nlohmann::json& json_;
};

// Of a render job, what belongs to one technique alone.
bool isTechniqueOption(std::string_view technique, std::string_view name) {
    const TechniqueEntry& entry = findTechnique(technique);
    return std::ranges::find(entry.options, name, &Param::name) != entry.options.end();
}

}  // namespace

Job renderJob(const State& state) {
    Job job;
    job.command = "render";
    job.scene = sceneOf(state, state.active);
    job.options = state.technique_options;
    job.options["technique"] = state.technique;
    job.seed = state.seed;
    job.window = windowJson(state).dump();
    return job;
}

std::string workspaceJson(const State& state) { return jobJson(renderJob(state)) + "\n"; }

State parseWorkspace(std::string_view source, std::string_view path) {
    State state;
    const JsonText text(source, path);
    const nlohmann::json& root = text.root();
    const bool is_job = root.is_object() && root.contains("format") && root["format"].is_string() &&
                        root["format"].get<std::string>().starts_with("searchlight-job/");
    if (!is_job) {
        state.scene = parseScene(source, path);
        state.models = {newSlot(state, {})};
        state.models.front().model = state.scene.model;
        normalise(state);
        return state;
    }
    const Job job = parseJob(source, path);
    if (!findCommand(job.command).uses_scene)
        throw text.error("/command", fmt::format("a job that does '{}' has no scene to show", job.command),
                         "expected render");
    state.scene = job.scene;
    state.seed = job.seed;
    state.models = {newSlot(state, {})};
    state.models.front().model = job.scene.model;
    if (const auto technique = job.options.find("technique"); technique != job.options.end())
        state.technique = std::get<std::string>(technique->second);
    for (const auto& [name, value] : job.options)
        if (isTechniqueOption(state.technique, name)) state.technique_options[name] = value;
    if (!job.window.empty()) WindowReader(text).read(state);
    normalise(state);
    return state;
}

}  // namespace searchlight::gui
