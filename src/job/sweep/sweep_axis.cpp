#include "job/sweep/sweep_axis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "base/error.h"
#include "base/text.h"
#include "job/command.h"
#include "scene/scene_fields.h"

namespace searchlight {

namespace {

constexpr double max_values = 10'000;  // of an axis

bool startsWith(const std::string& key, std::string_view section) {
    return key == section || key.starts_with(fmt::format("/{}/", section)) || key == fmt::format("/{}", section);
}

std::vector<std::string> sceneKeys() {
    std::vector<std::string> keys;
    for (const auto& field : scene_format::scene_fields) keys.push_back(field.param.name);
    for (const std::string& key : scene_format::scene_extra_keys)
        if (key != "format") keys.push_back(key);
    return keys;
}

bool isSceneKey(const std::string& key) {
    const std::vector<std::string> keys = sceneKeys();
    return std::ranges::find(keys, key) != keys.end();
}

const Param* optionOf(const std::string& key) {
    const auto found = std::ranges::find(sweptOptions(), key, &Param::name);
    return found == sweptOptions().end() ? nullptr : &*found;
}

void checkKey(const JsonText& text, const std::string& key, const std::string& pointer) {
    if (key == "scene" || key == "render" || key == "seed" || key.starts_with('/') || isSceneKey(key) || optionOf(key))
        return;
    std::vector<std::string> names = sceneKeys();
    names.insert(names.end(), {"scene", "render", "seed"});
    for (const Param& option : sweptOptions()) names.push_back(option.name);
    const Error unknown = unknownName(ErrorKind::input, "key", key, names);
    throw text.error(pointer, unknown.message, unknown.hint);
}

// The unit of a number that the key stands for; empty where there is none.
std::string unitOf(const std::string& key) {
    if (const Param* option = optionOf(key)) return option->unit;
    const std::string pointer = key.starts_with('/') ? key : "/" + key;
    const std::vector<std::string_view> steps = split(pointer, '/');
    const std::string section = steps.size() == 3 ? std::string(steps[1]) : "scene";
    for (const SceneSection& each : sceneSections())
        if (each.name == section)
            for (const Param& param : each.keys)
                if (param.name == steps.back()) return param.unit;
    return {};
}

// "/camera/azimuth_deg" -> "Azimuth (deg)".
std::string titleOf(const std::string& key) {
    std::string name(split(key, '/').back());
    const std::string unit = unitOf(key);
    if (name.ends_with("_" + unit)) name.resize(name.size() - unit.size() - 1);
    std::ranges::replace(name, '_', ' ');
    // Symbols keep their case: "g", "eta".
    if (name.size() > 3 && !name.starts_with("sigma")) name[0] = static_cast<char>(std::toupper(name[0]));
    return unit.empty() ? name : fmt::format("{} ({})", name, unit);
}

// What a reader calls a value that has no label.
std::string labelOf(const Json& value) {
    if (value.is_string()) return value.get<std::string>();
    if (value.is_number()) return prettyNumber(value.get<double>());
    if (value.is_null()) return "none";
    if (value.is_object()) {
        for (const char* name : {"id", "type", "object", "technique"})
            if (value.contains(name) && value[name].is_string()) return value[name].get<std::string>();
    }
    if (value.is_array() && !value.empty() &&
        std::ranges::all_of(value, [](const Json& part) { return part.is_object(); })) {
        std::vector<std::string> parts;
        for (const Json& part : value) parts.push_back(labelOf(part));
        return join(parts, " + ");
    }
    return value.dump();
}

// from + i (to - from) / n: `steps` leaves out the end, as frames of a full turn do, `count` includes it.
std::vector<Json> rangeOf(const JsonText& text, const nlohmann::json& json, const std::string& pointer) {
    const auto number = [&](const char* key) {
        if (!json.contains(key)) throw text.error(pointer, "expected values, or from and to with steps or count");
        return std::get<double>(text.value(pointer + "/" + key, json[key], {.name = key}));
    };
    const double from = number("from"), to = number("to");
    const bool open = json.contains("steps");
    if (open && json.contains("count")) throw text.error(pointer + "/count", "steps and count exclude each other");
    const char* key = open ? "steps" : "count";
    number(key);
    const Param counted{.name = key, .type = ParamType::integer, .min = open ? 1. : 2., .max = max_values};
    const double count = std::get<double>(text.value(pointer + "/" + key, json[key], counted));
    std::vector<Json> values;
    for (double i = 0; i < count; ++i) values.emplace_back(from + i * (to - from) / (open ? count : count - 1));
    return values;
}

}  // namespace

const std::vector<Param>& sweptOptions() {
    static const std::vector<Param> options = [] {
        std::vector<Param> list = findCommand("render").options;
        std::erase_if(list, [](const Param& param) { return param.name == "turntable"; });
        return list;
    }();
    return options;
}

AxisValues readAxis(const JsonText& text, const nlohmann::json& json, const std::string& pointer) {
    AxisValues read;
    if (!json.contains("key") || !json["key"].is_string())
        throw text.error(pointer, "an axis needs a key", "such as \"key\": \"material\"");
    read.axis.key = json["key"];
    checkKey(text, read.axis.key, pointer + "/key");
    if (json.contains("values")) {
        const nlohmann::json& values = json["values"];
        for (const char* key : {"from", "to", "steps", "count"})
            if (json.contains(key)) throw text.errorAtKey(pointer + "/" + key, "the axis has its values already");
        if (!values.is_array() || values.empty()) throw text.error(pointer + "/values", "expected a list of values");
        for (const nlohmann::json& value : values) read.values.push_back(Json::parse(value.dump()));
    } else {
        read.values = rangeOf(text, json, pointer);
    }
    for (const Json& value : read.values) read.axis.labels.push_back(labelOf(value));
    if (json.contains("labels")) {
        const nlohmann::json& labels = json["labels"];
        const bool texts =
            labels.is_array() && std::ranges::all_of(labels, [](const auto& label) { return label.is_string(); });
        if (!texts || labels.size() != read.values.size())
            throw text.error(pointer + "/labels", fmt::format("expected {} texts", read.values.size()));
        read.axis.labels = labels.get<std::vector<std::string>>();
    }
    read.axis.title = titleOf(read.axis.key);
    if (json.contains("title")) {
        if (!json["title"].is_string()) throw text.error(pointer + "/title", "expected text");
        read.axis.title = json["title"];
    }
    return read;
}

void applyValue(const std::string& key, const Json& value, CellText& cell) {
    if (key == "scene") return cell.scene.merge_patch(value);
    if (key == "render") return cell.options.merge_patch(value);
    if (key == "seed") {
        cell.seed = value;
        return;
    }
    if (optionOf(key)) {
        cell.options[key] = value;
        return;
    }
    if (!key.starts_with('/')) {
        cell.scene[key] = value;
        return;
    }
    const Error nowhere = inputError(fmt::format("'{}' leads nowhere in the scene", key),
                                     "a JSON pointer such as /camera/azimuth_deg or /lights/0/angle_deg");
    try {
        for (const char* section : {"material", "model"})
            if (startsWith(key, section) && cell.scene[section].is_string()) {
                Json named{{"id", cell.scene[section]}};  // "marble" is short for it
                cell.scene[section] = std::move(named);
            }
        for (const char* section : {"coat", "ground"})
            if (startsWith(key, section) && !cell.scene.contains(section)) cell.scene[section] = Json::object();
        const Json::json_pointer place(key);
        const Json::json_pointer parent = place.parent_pointer();
        // An index behind the end of a list would make the list longer.
        if (!cell.scene.contains(parent) || (cell.scene[parent].is_array() && !cell.scene.contains(place)))
            throw nowhere;
        cell.scene[place] = value;
    } catch (const Json::exception&) {
        throw nowhere;
    }
}

Job jobOf(const CellText& cell) {
    Json job;
    job["format"] = "searchlight-job/1";
    job["command"] = "render";
    job["scene"] = cell.scene;
    job["options"] = cell.options;
    job["seed"] = cell.seed;
    return parseJob(job.dump(), "cell");
}

int stageOf(const std::string& key) {
    for (const char* name : {"object", "scale", "scene", "points", "seed"})
        if (startsWith(key, name)) return 0;
    if (startsWith(key, "lights") || key == "light_samples") return 1;
    if (startsWith(key, "material")) return 2;
    return startsWith(key, "model") ? 3 : 4;
}

}  // namespace searchlight
