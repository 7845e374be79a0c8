#include "model/model.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/embedded.h"
#include "base/error.h"
#include "base/files.h"
#include "language/tokens.h"
#include "model/measured_file.h"
#include "model/sum_model.h"

namespace searchlight {

namespace {

constexpr std::string_view folder = "models/";
constexpr std::string_view ending = ".bssrdf";

std::string_view stemOf(std::string_view path) {
    path.remove_prefix(path.find_last_of("/\\") == std::string_view::npos ? 0 : path.find_last_of("/\\") + 1);
    return path.substr(0, path.rfind('.'));
}

Model parseModel(std::string_view text, std::string_view path) {
    Model model;
    model.id = stemOf(path);
    model.file = parseBssrdf(text, path);
    // A copy of a shipped model, under its own name, is that model.
    model.shipped = embeddedText(fmt::format("{}{}{}", folder, model.id, ending)) == text;
    return model;
}

bool isPath(std::string_view text) { return text.find_first_of("/\\.") != std::string_view::npos; }

}  // namespace

bool readsMedium(const Model& model) {
    if (!model.parts.empty()) return std::ranges::any_of(model.parts, readsMedium);
    for (const BssrdfSection* section : {&model.file.initializer, &model.file.shader})
        for (const Token& token : tokenize(section->text, section->first_line))
            if (token.text == "SigmaA" || token.text == "SigmaS" || token.text == "G" || token.text == "IOR")
                return true;
    return false;
}

const Param* ownLength(const Model& model) {
    const auto found = std::ranges::find_if(
        model.file.parameters, [](const Param& param) { return param.unit == "mm" || param.unit == "1/mm"; });
    return found == model.file.parameters.end() ? nullptr : &*found;
}

bool hasDiffuseReflectance(const Model& model) {
    if (!model.parts.empty()) return std::ranges::all_of(model.parts, hasDiffuseReflectance);
    return model.file.diffuse_reflectance.present();
}

const std::vector<Model>& shippedModels() {
    static const std::vector<Model> models = [] {
        std::vector<Model> found;
        for (const EmbeddedFile& file : embeddedFiles())
            if (file.path.starts_with(folder) && file.path.ends_with(ending))
                found.push_back(parseModel(file.text, file.path));
        return found;
    }();
    return models;
}

namespace {

Model loadOne(std::string_view id_or_path) {
    if (isPath(id_or_path)) {
        const std::string text = readFile(id_or_path);
        if (id_or_path.ends_with(ending)) return parseModel(text, id_or_path);
        if (!id_or_path.ends_with(".csv"))
            throw inputError("a model's file name ends in .bssrdf (a model) or .csv (a measured profile)")
                .at(id_or_path);
        Model model = parseMeasured(text, id_or_path);
        model.id = stemOf(id_or_path);
        return model;
    }
    std::vector<std::string> ids;
    for (const Model& model : shippedModels()) {
        if (model.id == id_or_path) return model;
        ids.push_back(model.id);
    }
    throw unknownName(ErrorKind::usage, "model", id_or_path, ids);
}

}  // namespace

Model loadModel(std::string_view name) {
    std::vector<Model> parts;
    for (const std::string& part : partNames(name)) parts.push_back(loadOne(part));
    return parts.size() == 1 ? std::move(parts.front()) : sumOf(std::move(parts));
}

}  // namespace searchlight
