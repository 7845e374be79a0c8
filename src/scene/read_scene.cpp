#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "base/text.h"
#include "scene/json_text.h"
#include "scene/scene.h"
#include "scene/scene_fields.h"

namespace searchlight {

namespace {

using namespace scene_format;
using nlohmann::json;

class SceneReader {
public:
    /// The scene is the value `root` that stands at the pointer `prefix` of `text`.
    SceneReader(const JsonText& text, std::string prefix) : text_(text), prefix_(std::move(prefix)) {}

    Scene read(const json& root) const {
        if (!root.is_object()) throw error("", "a scene is a JSON object", "{\"format\": \"searchlight-scene/1\"}");
        checkFormat(root);
        Scene scene;
        readFields(root, "", scene_fields, scene_extra_keys, scene);
        if (const json* value = member(root, "camera")) readSection(*value, "/camera", camera_fields, scene.camera);
        if (const json* value = member(root, "material")) scene.material = readMaterial(*value);
        if (const json* value = member(root, "model")) scene.model = readModel(*value);
        if (const json* value = member(root, "lights")) scene.lights = readLights(*value);
        if (const json* value = member(root, "ground"))
            readSection(*value, "/ground", ground_fields, scene.ground.emplace());
        if (const json* value = member(root, "coat")) scene.coat = readCoat(*value);
        if (const json* value = member(root, "backdrop"))
            scene.backdrop = std::get<Rgb>(valueAt("/backdrop", *value, backdrop_param));
        return scene;
    }

private:
    // The pointers of this class start at the scene; those of messages at the file's root.
    Error error(const std::string& pointer, std::string_view message, std::string hint = {}) const {
        return text_.error(prefix_ + pointer, message, std::move(hint));
    }
    Error errorAtKey(const std::string& pointer, std::string_view message, std::string hint = {}) const {
        return text_.errorAtKey(prefix_ + pointer, message, std::move(hint));
    }
    ParamValue valueAt(const std::string& pointer, const json& value, const Param& param) const {
        return text_.value(prefix_ + pointer, value, param);
    }

    static const json* member(const json& object, std::string_view key) {
        const auto found = object.find(key);
        return found == object.end() || found->is_null() ? nullptr : &*found;
    }

    void checkFormat(const json& root) const {
        const json* format = member(root, "format");
        if (!format && !prefix_.empty()) return;  // within a job, whose format says it
        if (!format) throw error("", "no format", "expected \"format\": \"searchlight-scene/1\"");
        const std::string name = format->is_string() ? format->get<std::string>() : format->dump();
        if (!name.starts_with(format_name))
            throw error("/format", fmt::format("'{}' is no scene", name), "expected searchlight-scene/1");
        const std::optional<double> version = parseNumber(std::string_view(name).substr(format_name.size()));
        if (version && *version > format_version)
            throw error("/format", fmt::format("'{}' is newer than this program", name),
                        "it reads searchlight-scene/1");
        if (version != format_version)
            throw error("/format", fmt::format("unknown version '{}'", name), "expected searchlight-scene/1");
    }

    template <class T>
    void readField(const json& value, const std::string& pointer, const Field<T>& field, T& into) const {
        if (Vec3 T::*const* vector = std::get_if<Vec3 T::*>(&field.member)) {
            const auto numeric = [](const json& part) { return part.is_number(); };
            if (!value.is_array() || value.size() != 3 || !std::ranges::all_of(value, numeric))
                throw error(pointer, fmt::format("no value for {}", field.param.name), "expected [x, y, z]");
            into.** vector = {value[0].get<double>(), value[1].get<double>(), value[2].get<double>()};
            return;
        }
        const ParamValue read = valueAt(pointer, value, field.param);
        std::visit(
            [&]<class Value>(Value T::*member) {
                if constexpr (!std::is_same_v<Value, Vec3>) into.*member = std::get<Value>(read);
            },
            field.member);
    }

    // Reads the fields of an object; keys that are neither fields nor `others` are refused.
    template <class T>
    void readFields(const json& object, const std::string& pointer, const std::vector<Field<T>>& fields,
                    const std::vector<std::string>& others, T& into) const {
        std::vector<std::string> keys = others;
        for (const Field<T>& field : fields) keys.push_back(field.param.name);
        for (const auto& [key, value] : object.items()) {
            const std::string at = pointer + pointerStep(key);
            if (std::ranges::find(keys, key) == keys.end()) {
                const Error unknown = unknownName(ErrorKind::input, "key", key, keys);
                throw errorAtKey(at, unknown.message, unknown.hint);
            }
            const auto field = std::ranges::find(fields, key, [](const Field<T>& f) { return f.param.name; });
            if (field != fields.end()) readField(value, at, *field, into);
        }
    }

    template <class T>
    void readSection(const json& value, const std::string& pointer, const std::vector<Field<T>>& fields,
                     T& into) const {
        if (!value.is_object()) throw error(pointer, "expected an object");
        readFields(value, pointer, fields, {}, into);
    }

    SceneMaterial readMaterial(const json& value) const {
        SceneMaterial material;
        if (value.is_string()) {
            material.id = value.get<std::string>();
            if (material.id.empty()) throw error("/material", "'' is no material", "expected an id");
            return material;
        }
        if (!value.is_object())
            throw error("/material", "expected an id or an object",
                        "such as \"skin1\" or {\"sigma_a\": 0.1, \"sigma_s\": 2}");
        material.id.clear();
        readFields(value, "/material", material_fields, {}, material);
        const bool named = value.contains("id");
        const bool spelled = value.contains("sigma_a") || value.contains("sigma_s");
        const bool inverted = value.contains("Rdr") || value.contains("ld");
        const auto complete = [&](const char* a, const char* b) { return value.contains(a) && value.contains(b); };
        if (named + spelled + inverted != 1 || (spelled && !complete("sigma_a", "sigma_s")) ||
            (inverted && !complete("Rdr", "ld")))
            throw error("/material", "expected an id, or sigma_a and sigma_s, or Rdr and ld");
        if (named) {
            for (const char* key : {"g", "eta"})
                if (value.contains(key))
                    throw errorAtKey(std::string("/material/") + key, "a named material has its own");
            return material;
        }
        try {
            const std::vector<double> any{1};  // in place of what the inversion will find
            makeMedium(spelled ? material.sigma_a : any, spelled ? material.sigma_s : any, material.g, material.eta);
        } catch (const Error& bad) {
            throw error("/material", bad.message, bad.hint);
        }
        return material;
    }

    SceneModel readModel(const json& value) const {
        SceneModel model;
        if (value.is_string()) {
            readField(value, "/model", model_fields.front(), model);
            return model;
        }
        if (!value.is_object())
            throw error("/model", "expected an id or an object",
                        "such as \"dipole\" or {\"id\": \"dipole\", \"parameters\": {}}");
        readFields(value, "/model", model_fields, {"parameters"}, model);
        model.parameters = readParameters(value, "/model");
        return model;
    }

    Coat readCoat(const json& value) const {
        if (!value.is_object()) throw error("/coat", "expected an object");
        Coat coat;
        readFields(value, "/coat", coat_fields, {"parameters"}, coat);
        coat.parameters = readParameters(value, "/coat");
        if (coat.brdf.empty() && !coat.parameters.empty())
            throw errorAtKey("/coat/parameters", "there is no .brdf file for these parameters", "add \"brdf\"");
        return coat;
    }

    ParamValues readParameters(const json& section, const std::string& pointer) const {
        ParamValues values;
        const json* parameters = member(section, "parameters");
        if (!parameters) return values;
        if (!parameters->is_object()) throw error(pointer + "/parameters", "expected an object");
        for (const auto& [name, given] : parameters->items()) {
            // What the file makes of a value is not known here: any shape that a Param can have is taken.
            Param any;
            any.name = name;
            any.type = given.is_string()    ? ParamType::text
                       : given.is_boolean() ? ParamType::toggle
                       : given.is_array()   ? ParamType::numbers
                                            : ParamType::number;
            values[name] = valueAt(pointer + "/parameters" + pointerStep(name), given, any);
        }
        return values;
    }

    std::vector<Light> readLights(const json& value) const {
        if (!value.is_array()) throw error("/lights", "expected a list of lights");
        std::vector<Light> lights;
        for (std::size_t i = 0; i < value.size(); ++i)
            lights.push_back(readLight(value[i], fmt::format("/lights/{}", i)));
        return lights;
    }

    Light readLight(const json& value, const std::string& pointer) const {
        const json* type = value.is_object() ? member(value, "type") : nullptr;
        if (!type) throw error(pointer, "a light is an object with a type", "directional, environment or point");
        if (*type == "directional") {
            DirectionalLight light;
            readFields(value, pointer, directional_fields, {"type"}, light);
            if (length(light.direction) == 0) throw error(pointer + "/direction", "0,0,0 is no direction");
            return light;
        }
        if (*type == "environment") {
            EnvironmentLight light;
            readFields(value, pointer, environment_fields, {"type"}, light);
            if (light.path.empty()) throw error(pointer, "an environment needs a path");
            return light;
        }
        if (*type == "point") {
            PointLight light;
            readFields(value, pointer, point_fields, {"type"}, light);
            return light;
        }
        const Error unknown =
            unknownName(ErrorKind::input, "light", type->is_string() ? type->get<std::string>() : type->dump(),
                        {"directional", "environment", "point"});
        throw error(pointer + "/type", unknown.message, unknown.hint);
    }

    const JsonText& text_;
    std::string prefix_;  ///< JSON pointer of the scene in its file
};

}  // namespace

Scene parseScene(std::string_view text, std::string_view path) {
    const JsonText json_text(text, path);
    return readScene(json_text, "");
}

Scene readScene(const JsonText& text, const std::string& pointer) {
    return SceneReader(text, pointer).read(text.root().at(json::json_pointer(pointer)));
}

}  // namespace searchlight
