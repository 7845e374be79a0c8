#include "scene_flags.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "base/error.h"
#include "base/files.h"
#include "base/text.h"
#include "job/engine.h"
#include "render/brdf_file.h"

namespace searchlight {

namespace {

constexpr SceneFlag flags[] = {
    {"object", "a built-in object, a mesh or point cloud file, or a scene file (.json) (default sphere)"},
    {"scale", "length of the object's longest side [mm] (default 10)"},
    {"model", "a model's id, a .bssrdf file or a measured .csv profile (default dipole)"},
    {"set", "model parameters: name=value, several separated by commas"},
    {"light", "dir:x,y,z towards it, point:x,y,z, env:FILE or none; may be repeated (default dir:1,1,1)"},
    {"irradiance", "of directional and point lights: one number or R,G,B (default 1)"},
    {"sun_angle", "diameter of the disc that a directional light is; the sun: 0.53 [deg] (default 0)"},
    {"filter", "a picture that directional light passes"},
    {"occlusion", "the object shadows itself from environments", true},
    {"camera", "azimuth,elevation[,distance] in degrees and longest sides (default 30,15, framed)"},
    {"fov", "vertical field of view [deg] (default 35)"},
    {"target", "x,y,z that the camera looks at, in longest sides from the centre (default 0,0,0)"},
    {"ground", "a diffuse plane under the object, at a height above its lowest point (default 0)", true},
    {"backdrop", "radiance behind everything: one number or R,G,B (default: transparent, or the environment)"},
    {"coat", "a surface on top: its roughness, or a .brdf file"},
    {"brdf_set", "parameters of that file: name=value, several separated by commas"},
};

const Param& keyOf(std::string_view section, std::string_view key) {
    const auto found = std::ranges::find(sceneSections(), section, &SceneSection::name);
    return findParam(found->keys, key, "option");
}

class Typed {
public:
    explicit Typed(const TypedFlags& values) : values_(values) {}

    bool has(std::string_view flag) const { return find(flag) != nullptr; }
    const std::string& text(std::string_view flag) const { return find(flag)->back(); }
    const std::vector<std::string>& all(std::string_view flag) const { return *find(flag); }

    /// The last value, read as the scene format reads that key.
    template <class T>
    T value(std::string_view flag, std::string_view section, std::string_view key) const {
        return read<T>(flag, keyOf(section, key), text(flag));
    }

    /// As value(), and the message calls it what the user typed.
    template <class T>
    static T read(std::string_view flag, Param param, std::string_view text) {
        param.name = flag;
        return std::get<T>(parseValue(param, text));
    }

private:
    const std::vector<std::string>* find(std::string_view flag) const {
        const auto found = values_.find(flag);
        return found == values_.end() || found->second.empty() ? nullptr : &found->second;
    }

    const TypedFlags& values_;
};

Vec3 vectorOf(std::string_view flag, std::string_view text) {
    const Param numbers{.name = std::string(flag), .type = ParamType::numbers};
    const auto list = std::get<std::vector<double>>(parseValue(numbers, text));
    if (list.size() != 3) throw usageError(fmt::format("'{}' is no value for {}", text, flag), "expected x,y,z");
    return {list[0], list[1], list[2]};
}

Light lightOf(const std::string& text) {
    const std::size_t colon = text.find(':');
    const std::string kind = text.substr(0, colon);
    const std::string rest = colon == std::string::npos ? std::string() : text.substr(colon + 1);
    if (kind == "dir") {
        const Vec3 direction = vectorOf("light dir", rest);
        if (length(direction) == 0) throw usageError("0,0,0 is no direction of a light", "such as dir:1,1,1");
        return DirectionalLight{.direction = direction};
    }
    if (kind == "point") return PointLight{.position = vectorOf("light point", rest)};
    if (kind == "env") {
        if (rest.empty()) throw usageError("--light env needs a picture", "env:FILE.hdr");
        return EnvironmentLight{.path = rest};
    }
    throw usageError(fmt::format("'{}' is no light", text), "expected dir:x,y,z, point:x,y,z, env:FILE or none");
}

void applyLights(const Typed& typed, std::vector<Light>& lights) {
    if (typed.has("light")) {
        lights.clear();
        const std::vector<std::string>& given = typed.all("light");
        const bool none = std::ranges::find(given, "none") != given.end();
        if (none && given.size() > 1) throw usageError("--light none stands alone", "give lights, or none");
        if (!none)
            for (const std::string& text : given) lights.push_back(lightOf(text));
    }
    const auto refine = [&](std::string_view flag, std::string_view kinds, const auto& change) {
        if (!typed.has(flag)) return;
        bool any = false;
        for (Light& light : lights) any |= change(light);
        std::string name = "--" + std::string(flag);
        std::ranges::replace(name, '_', '-');
        if (!any) throw usageError(fmt::format("{} has no light to belong to", name), std::string(kinds));
    };
    refine("irradiance", "add --light dir:x,y,z or point:x,y,z", [&](Light& light) {
        const Rgb value = typed.value<Rgb>("irradiance", "directional light", "irradiance");
        if (auto* sun = std::get_if<DirectionalLight>(&light)) return sun->irradiance = value, true;
        if (auto* point = std::get_if<PointLight>(&light)) return point->intensity = value, true;
        return false;
    });
    refine("sun_angle", "add --light dir:x,y,z", [&](Light& light) {
        auto* sun = std::get_if<DirectionalLight>(&light);
        if (sun) sun->angle_deg = typed.value<double>("sun_angle", "directional light", "angle_deg");
        return sun != nullptr;
    });
    refine("filter", "add --light dir:x,y,z", [&](Light& light) {
        auto* sun = std::get_if<DirectionalLight>(&light);
        if (sun) sun->filter = typed.text("filter");
        return sun != nullptr;
    });
    refine("occlusion", "add --light env:FILE", [&](Light& light) {
        auto* environment = std::get_if<EnvironmentLight>(&light);
        const std::string& text = typed.text("occlusion");
        if (environment)
            environment->occlusion = text.empty() || typed.value<bool>("occlusion", "environment light", "occlusion");
        return environment != nullptr;
    });
}

void applyCamera(const Typed& typed, Camera& camera) {
    if (typed.has("camera")) {
        const std::vector<std::string_view> parts = split(typed.text("camera"), ',');
        if (parts.size() < 2 || parts.size() > 3)
            throw usageError(fmt::format("'{}' is no value for camera", typed.text("camera")),
                             "expected azimuth,elevation or azimuth,elevation,distance");
        const auto part = [&](std::size_t i, const char* key) {
            return Typed::read<double>(fmt::format("camera {}", key), keyOf("camera", key), parts[i]);
        };
        camera.azimuth_deg = part(0, "azimuth_deg");
        camera.elevation_deg = part(1, "elevation_deg");
        camera.distance = parts.size() == 3 ? part(2, "distance") : 0;
    }
    if (typed.has("fov")) camera.field_of_view_deg = typed.value<double>("fov", "camera", "field_of_view_deg");
    if (typed.has("target")) camera.target = vectorOf("target", typed.text("target"));
}

// As parseSettings() takes them: it puts the values of a list together again.
std::vector<std::string> cutAtCommas(const std::vector<std::string>& given) {
    std::vector<std::string> parts;
    for (const std::string& text : given)
        for (const std::string_view part : split(text, ',')) parts.emplace_back(part);
    return parts;
}

void setAll(const ParamValues& given, ParamValues& parameters) {
    for (const auto& [name, value] : given) {
        const Rgb* color = std::get_if<Rgb>(&value);  // in a scene, a list like any other
        parameters[name] = color ? ParamValue(std::vector<double>{color->r, color->g, color->b}) : value;
    }
}

// "better_dipole:Moments=exact" and --set become the scene's values by name.
void applyModel(const Typed& typed, SceneModel& model) {
    std::vector<std::string> settings;
    if (typed.has("model")) {
        model = {};
        const std::vector<std::string_view> parts = split(typed.text("model"), ':');
        model.id = parts.front();
        for (std::size_t i = 1; i < parts.size(); ++i) settings.emplace_back(parts[i]);
    }
    if (typed.has("set")) std::ranges::move(cutAtCommas(typed.all("set")), std::back_inserter(settings));
    if (settings.empty()) return;
    const Model loaded = loadModel(model.id);
    setAll(parseSettings(loaded, settings), model.parameters);
}

void applyCoat(const Typed& typed, std::optional<Coat>& coat) {
    if (typed.has("coat")) {
        const std::string& text = typed.text("coat");
        coat.emplace();
        if (parseNumber(text))
            coat->roughness = typed.value<double>("coat", "coat", "roughness");
        else if (text.ends_with(".brdf"))
            coat->brdf = text;
        else
            throw usageError(fmt::format("'{}' is no coat", text), "expected a roughness from 0 to 1, or a .brdf file");
    }
    if (!typed.has("brdf_set")) return;
    if (!coat || coat->brdf.empty())
        throw usageError("--brdf-set is for a coat from a .brdf file", "such as --coat paint.brdf");
    const BrdfFile file = parseBrdf(readFile(coat->brdf), coat->brdf);
    setAll(parseSettings(file.parameters, file.path, cutAtCommas(typed.all("brdf_set"))), coat->parameters);
}

}  // namespace

std::span<const SceneFlag> sceneFlags() { return flags; }

void applySceneFlags(const TypedFlags& values, Scene& scene) {
    const Typed typed(values);
    if (typed.has("object")) scene.object = typed.text("object");
    if (typed.has("scale")) scene.scale = typed.value<double>("scale", "scene", "scale");
    applyModel(typed, scene.model);
    applyLights(typed, scene.lights);
    applyCamera(typed, scene.camera);
    if (typed.has("ground")) {
        if (!scene.ground) scene.ground.emplace();
        if (!typed.text("ground").empty()) scene.ground->height = typed.value<double>("ground", "ground", "height");
    }
    if (typed.has("backdrop")) scene.backdrop = typed.value<Rgb>("backdrop", "scene", "backdrop");
    applyCoat(typed, scene.coat);
}

}  // namespace searchlight
