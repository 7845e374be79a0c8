#include "gui/state/command_line.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <optional>

#include "base/text.h"

namespace searchlight::gui {

namespace {

std::string texts(Vec3 v) { return fmt::format("{},{},{}", numberText(v.x), numberText(v.y), numberText(v.z)); }
std::string texts(Rgb v) { return fmt::format("{},{},{}", numberText(v.r), numberText(v.g), numberText(v.b)); }

bool equal(Vec3 a, Vec3 b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

// Flags speak of all lights at once.
struct LightFlags {
    std::vector<std::string> flags;
    bool suffice = true;
};

LightFlags lightFlags(const std::vector<Light>& lights) {
    LightFlags out;
    std::optional<Rgb> irradiance;
    std::optional<double> angle;
    std::optional<std::string> filter;
    std::optional<bool> occlusion;
    const auto same = [&](auto& all, const auto& value) {
        if (all && *all != value) out.suffice = false;
        all = value;
    };
    if (lights.empty()) out.flags.emplace_back("--light none");
    for (const Light& light : lights) {
        if (const auto* sun = std::get_if<DirectionalLight>(&light)) {
            out.flags.push_back("--light dir:" + texts(sun->direction));
            same(irradiance, sun->irradiance);
            same(angle, sun->angle_deg);
            same(filter, sun->filter);
        } else if (const auto* point = std::get_if<PointLight>(&light)) {
            out.flags.push_back("--light point:" + texts(point->position));
            same(irradiance, point->intensity);
        } else if (const auto* environment = std::get_if<EnvironmentLight>(&light)) {
            out.flags.push_back("--light " + shellWord("env:" + environment->path));
            same(occlusion, environment->occlusion);
            if (environment->intensity != Rgb{1, 1, 1} || environment->rotation_deg != 0 ||
                environment->layout != EnvironmentLight{}.layout)
                out.suffice = false;
        }
    }
    if (irradiance && *irradiance != Rgb{1, 1, 1}) out.flags.push_back("--irradiance " + texts(*irradiance));
    if (angle && *angle != 0) out.flags.push_back("--sun-angle " + numberText(*angle));
    if (filter && !filter->empty()) out.flags.push_back("--filter " + shellWord(*filter));
    if (occlusion && *occlusion) out.flags.emplace_back("--occlusion");
    return out;
}

std::string optionFlag(const std::string& name, const ParamValue& value) {
    std::string flag = "--" + name;
    std::ranges::replace(flag, '_', '-');
    if (const bool* on = std::get_if<bool>(&value)) return *on ? flag : flag + "=false";
    return flag + " " + shellWord(valueText(value));
}

std::string byJob(const Job& job) { return fmt::format("searchlight run /dev/stdin <<'END'\n{}\nEND", jobJson(job)); }

}  // namespace

std::string shellWord(const std::string& text) {
    constexpr std::string_view plain = "_-./:,=+@%";
    const bool safe = !text.empty() && std::ranges::all_of(text, [&](unsigned char c) {
        return std::isalnum(c) != 0 || plain.find(static_cast<char>(c)) != std::string_view::npos;
    });
    if (safe) return text;
    std::string quoted = "'";
    for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return quoted + "'";
}

std::vector<std::string> materialFlags(const SceneMaterial& material, const SceneModel* inverted_by) {
    std::vector<std::string> flags;
    if (!material.id.empty()) {
        flags.push_back("--material " + shellWord(material.id));
    } else {
        const auto list = [&](const char* flag, const std::vector<double>& values) {
            if (!values.empty()) flags.push_back(fmt::format("{} {}", flag, valueText(values)));
        };
        list("--sigma-a", material.sigma_a);
        list("--sigma-s", material.sigma_s);
        list("--Rdr", material.Rdr);
        list("--ld", material.ld);
        list("--g", material.g);
        if (material.inverted() && inverted_by) {
            std::string model = inverted_by->id;
            for (const auto& [name, value] : inverted_by->parameters)
                model += fmt::format(":{}={}", name, valueText(value));
            flags.push_back("--inverted-by " + shellWord(model));
        }
        flags.push_back("--eta " + numberText(material.eta));
    }
    if (material.scale != 1) flags.push_back("--material-scale " + numberText(material.scale));
    return flags;
}

std::string commandLine(const State& state, const PictureFile& file) {
    Job job = renderJob(state);
    job.window.clear();
    job.output = file.path;
    job.options["size"] = fmt::format("{}x{}", file.width, file.height);
    // A thousandth of a stop is less than a step of 8 bits.
    job.options["exposure"] = fmt::format("{:.3f}", file.exposure);
    if (const ParamValue& curve = optionOf(state, "view", "curve"); curve != ParamValue(std::string("srgb")))
        job.options["curve"] = curve;
    if (const ParamValue& gamma = optionOf(state, "view", "gamma"); gamma != ParamValue(1.0))
        job.options["gamma"] = gamma;
    const Scene& scene = job.scene;
    const Camera standard;
    LightFlags lights = lightFlags(scene.lights);
    if (!lights.suffice || (scene.coat && !scene.coat->parameters.empty()) ||
        (scene.ground && scene.ground->albedo != Ground{}.albedo))
        return byJob(job);
    std::vector<std::string> words{"searchlight render", shellWord(scene.object), "--scale " + numberText(scene.scale),
                                   "--model " + shellWord(scene.model.id)};
    for (const auto& [name, value] : scene.model.parameters)
        words.push_back("--set " + shellWord(name + "=" + valueText(value)));
    for (std::string& flag : materialFlags(scene.material, nullptr)) words.push_back(std::move(flag));
    words.insert(words.end(), lights.flags.begin(), lights.flags.end());
    const Camera& camera = scene.camera;
    std::string at = numberText(camera.azimuth_deg) + "," + numberText(camera.elevation_deg);
    if (camera.distance > 0) at += "," + numberText(camera.distance);
    words.push_back("--camera=" + at);
    if (camera.field_of_view_deg != standard.field_of_view_deg)
        words.push_back("--fov " + numberText(camera.field_of_view_deg));
    if (!equal(camera.target, standard.target)) words.push_back("--target=" + texts(camera.target));
    if (scene.ground) words.push_back("--ground=" + numberText(scene.ground->height));
    if (scene.backdrop) words.push_back("--backdrop " + texts(*scene.backdrop));
    if (scene.coat)
        words.push_back("--coat " +
                        (scene.coat->brdf.empty() ? numberText(scene.coat->roughness) : shellWord(scene.coat->brdf)));
    for (const auto& [name, value] : job.options) words.push_back(optionFlag(name, value));
    if (job.seed != 1) words.push_back(fmt::format("--seed {}", job.seed));
    words.push_back("-o " + shellWord(file.path));
    return join(words, " ");
}

}  // namespace searchlight::gui
