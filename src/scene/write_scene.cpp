#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "scene/scene.h"
#include "scene/scene_fields.h"

namespace searchlight {

namespace {

using namespace scene_format;
using nlohmann::ordered_json;

ordered_json toJson(Vec3 v) { return {v.x, v.y, v.z}; }
ordered_json toJson(const Rgb& c) { return {c.r, c.g, c.b}; }
template <class Value>
ordered_json toJson(const Value& value) {
    return value;
}

template <class T>
void writeFields(const T& from, const std::vector<Field<T>>& fields, ordered_json& object) {
    for (const Field<T>& field : fields)
        std::visit([&](auto member) { object[field.param.name] = toJson(from.*member); }, field.member);
}

template <class T>
ordered_json section(const T& from, const std::vector<Field<T>>& fields) {
    ordered_json object;
    writeFields(from, fields, object);
    return object;
}

ordered_json materialJson(const SceneMaterial& material) {
    if (!material.id.empty()) {
        if (material.scale == 1) return material.id;
        return {{"id", material.id}, {"scale", material.scale}};
    }
    ordered_json object = section(material, material_fields);
    object.erase("id");
    for (const char* key : {"Rdr", "ld"})
        if (!material.inverted()) object.erase(key);
    for (const char* key : {"sigma_a", "sigma_s"})
        if (material.inverted()) object.erase(key);
    return object;
}

ordered_json parametersJson(const ParamValues& values) {
    ordered_json object = ordered_json::object();
    for (const auto& parameter : values)
        std::visit([&](const auto& value) { object[parameter.first] = toJson(value); }, parameter.second);
    return object;
}

ordered_json modelJson(const SceneModel& model) {
    ordered_json object = section(model, model_fields);
    object["parameters"] = parametersJson(model.parameters);
    return object;
}

ordered_json coatJson(const Coat& coat) {
    ordered_json object = section(coat, coat_fields);
    object["parameters"] = parametersJson(coat.parameters);
    return object;
}

template <class T>
ordered_json typed(const char* type, const T& light, const std::vector<Field<T>>& fields) {
    ordered_json object;
    object["type"] = type;
    writeFields(light, fields, object);
    return object;
}

ordered_json toJson(const DirectionalLight& light) { return typed("directional", light, directional_fields); }
ordered_json toJson(const EnvironmentLight& light) { return typed("environment", light, environment_fields); }
ordered_json toJson(const PointLight& light) { return typed("point", light, point_fields); }

template <class T>
SceneSection describe(const char* name, const char* doc, const std::vector<Field<T>>& fields) {
    SceneSection described{name, doc, {}};
    for (const Field<T>& field : fields) described.keys.push_back(field.param);
    return described;
}

}  // namespace

const std::vector<SceneSection>& sceneSections() {
    static const std::vector<SceneSection> sections = [] {
        std::vector<SceneSection> list{
            describe("scene", "the whole file", scene_fields),
            describe("camera", "an orbit around a target", camera_fields),
            describe("material", "an id, or the numbers of a medium", material_fields),
            describe("model", "an id, or an id with parameters", model_fields),
            describe("directional light", "parallel light, or a disc in the sky", directional_fields),
            describe("environment light", "a picture all around", environment_fields),
            describe("point light", "light from one point", point_fields),
            describe("ground", "a plane below the object", ground_fields),
            describe("coat", "a surface that reflects, on top", coat_fields),
        };
        list.front().keys.push_back(backdrop_param);
        return list;
    }();
    return sections;
}

std::string sceneJson(const Scene& scene) {
    ordered_json root;
    root["format"] = fmt::format("{}{}", format_name, format_version);
    writeFields(scene, scene_fields, root);
    root["camera"] = section(scene.camera, camera_fields);
    root["material"] = materialJson(scene.material);
    root["model"] = modelJson(scene.model);
    root["lights"] = ordered_json::array();
    for (const Light& light : scene.lights)
        root["lights"].push_back(std::visit([](const auto& l) { return toJson(l); }, light));
    if (scene.ground) root["ground"] = section(*scene.ground, ground_fields);
    if (scene.backdrop) root["backdrop"] = toJson(*scene.backdrop);
    if (scene.coat) root["coat"] = coatJson(*scene.coat);
    return root.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace searchlight
