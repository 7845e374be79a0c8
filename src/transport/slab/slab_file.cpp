// searchlight-layers/1: the layers of a slab as JSON.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "base/error.h"
#include "base/files.h"
#include "scene/json_text.h"
#include "transport/slab/slab.h"

namespace searchlight {

namespace {

using nlohmann::json;

constexpr std::string_view kFormat = "searchlight-layers/1";

Param number(const char* name, const char* unit, double min, double max, double value = 0) {
    return {.name = name, .unit = unit, .min = min, .max = max, .value = value};
}

const std::vector<Param>& slabParams() {
    static const std::vector<Param> list{number("n_above", "", 0.1, 10, 1), number("n_below", "", 0.1, 10, 1)};
    return list;
}

const std::vector<Param>& layerParams() {
    static const std::vector<Param> list{number("n", "", 0.1, 10, 1), number("sigma_a", "1/mm", 0, 1e9),
                                         number("sigma_s", "1/mm", 0, 1e9), number("g", "", -0.9999, 0.9999),
                                         number("thickness_mm", "mm", 0, 1e10)};
    return list;
}

class LayersReader {
public:
    LayersReader(std::string_view text, std::string_view path) : text_(text, path), path_(path) {}

    SlabProblem read() const {
        const json& root = text_.root();
        if (!root.is_object())
            throw text_.error("", "a slab is a JSON object", fmt::format("{{\"format\": \"{}\"}}", kFormat));
        checkFormat(root);
        checkKeys(root, "", slabParams(), {"format", "layers"});
        SlabProblem problem;
        problem.n_above = numberAt(root, "", slabParams()[0]);
        problem.n_below = numberAt(root, "", slabParams()[1]);
        if (!root.contains("layers")) throw text_.error("", "no layers", "expected \"layers\": [{...}, ...]");
        const json& layers = root["layers"];
        if (!layers.is_array() || layers.empty()) throw text_.error("/layers", "no layers", "expected [{...}, ...]");
        for (std::size_t i = 0; i < layers.size(); ++i)
            problem.layers.push_back(layer(layers[i], fmt::format("/layers/{}", i), i + 1 == layers.size()));
        return problem;
    }

private:
    void checkFormat(const json& root) const {
        if (!root.contains("format")) throw text_.error("", "no format", fmt::format("expected \"{}\"", kFormat));
        const json& format = root["format"];
        if (format != kFormat)
            throw text_.error("/format", fmt::format("unknown format {}", format.dump()),
                              fmt::format("expected \"{}\"", kFormat));
    }

    void checkKeys(const json& object, const std::string& pointer, const std::vector<Param>& params,
                   std::vector<std::string> valid) const {
        for (const Param& param : params) valid.push_back(param.name);
        for (const auto& [key, value] : object.items()) {
            if (std::ranges::find(valid, key) != valid.end()) continue;
            const Error unknown = unknownName(ErrorKind::input, "key", key, valid);
            throw text_.errorAtKey(pointer + pointerStep(key), unknown.message, unknown.hint);
        }
    }

    double numberAt(const json& object, const std::string& pointer, const Param& param) const {
        const auto found = object.find(param.name);
        if (found == object.end()) return std::get<double>(param.value);
        return std::get<double>(text_.value(pointer + pointerStep(param.name), *found, param));
    }

    SlabLayer layer(const json& object, const std::string& pointer, bool last) const {
        if (!object.is_object())
            throw text_.error(pointer, "a layer is a JSON object", "{\"sigma_a\": ..., \"thickness_mm\": ...}");
        checkKeys(object, pointer, layerParams(), {"phase"});
        for (const char* key : {"n", "sigma_a", "sigma_s", "thickness_mm"})
            if (!object.contains(key)) throw text_.error(pointer, fmt::format("the layer has no {}", key));
        SlabLayer layer;
        const std::vector<Param>& params = layerParams();
        layer.n = numberAt(object, pointer, params[0]);
        layer.sigma_a = numberAt(object, pointer, params[1]);
        layer.sigma_s = numberAt(object, pointer, params[2]);
        layer.g = numberAt(object, pointer, params[3]);
        if (object.contains("phase")) layer.phase = phase(object, pointer);
        if (object["thickness_mm"] != "infinite") {
            layer.thickness_mm = numberAt(object, pointer, params[4]);
            return layer;
        }
        const std::string thickness = pointer + "/thickness_mm";
        if (!last) throw text_.error(thickness, "only the last layer may be infinite");
        if (layer.clear())
            throw text_.error(thickness, "a clear layer cannot be infinite", "light would never end in it");
        layer.thickness_mm = std::numeric_limits<double>::infinity();
        return layer;
    }

    PhaseFunction phase(const json& object, const std::string& pointer) const {
        const std::string at = pointer + "/phase";
        if (object.contains("g")) throw text_.error(at, "phase and g exclude each other", "give one of the two");
        const json& name = object["phase"];
        if (!name.is_string() || name.get<std::string>().empty())
            throw text_.error(at, "the phase function has no name", "\"rayleigh\", or a file with angle_deg, p");
        if (name == "rayleigh") return rayleighPhase();
        const std::filesystem::path file = path_.parent_path() / name.get<std::string>();
        return parsePhase(readFile(file), file.string());
    }

    JsonText text_;
    std::filesystem::path path_;
};

}  // namespace

SlabProblem parseLayers(std::string_view text, std::string_view path) { return LayersReader(text, path).read(); }

}  // namespace searchlight
