#include "model/sum_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "base/error.h"
#include "base/text.h"

namespace searchlight {

namespace {

bool isWhole(std::string_view name) {
    return name.find_first_of("/\\.") == std::string_view::npos || name.ends_with(".bssrdf") || name.ends_with(".csv");
}

std::string qualified(const Model& part, std::string_view name) { return fmt::format("{}.{}", part.id, name); }

bool isUnique(const std::vector<Model>& parts, std::string_view parameter) {
    return std::ranges::count_if(parts, [&](const Model& part) {
               return std::ranges::find(part.file.parameters, parameter, &Param::name) != part.file.parameters.end();
           }) == 1;
}

std::string listedName(const std::vector<Model>& parts, const Model& part, const std::string& parameter) {
    return isUnique(parts, parameter) ? parameter : qualified(part, parameter);
}

// "Better dipole: far from source. Single scattering: flat": a text of each part that has one.
std::string gathered(const std::vector<Model>& parts, std::string BssrdfFile::*text) {
    std::vector<std::string> lines;
    for (const Model& part : parts)
        if (!(part.file.*text).empty()) lines.push_back(fmt::format("{}: {}", part.file.title, part.file.*text));
    return join(lines, "; ");
}

std::vector<std::string> attributesOf(const BssrdfFile& file) {
    std::vector<std::string> names{"sum"};
    const std::pair<bool, const char*> known[] = {{file.radial, "radial"},
                                                  {file.no_wi, "no_wi"},
                                                  {file.no_wo, "no_wo"},
                                                  {file.normals, "normals"},
                                                  {file.single_scattering, "single_scattering"},
                                                  {file.reciprocal, "reciprocal"},
                                                  {file.energy_violation, "energy_violation"},
                                                  {file.grosjean, "grosjean"}};
    for (const auto& [holds, name] : known)
        if (holds) names.emplace_back(name);
    return names;
}

}  // namespace

std::vector<std::string> partNames(std::string_view name) {
    std::error_code ignored;
    if (name.find('+') == std::string_view::npos || std::filesystem::exists(name, ignored)) return {std::string(name)};
    std::vector<std::string> parts;
    for (const std::string_view piece : split(name, '+')) {
        if (!parts.empty() && !isWhole(parts.back()))
            parts.back() += fmt::format("+{}", piece);
        else
            parts.emplace_back(trim(piece));
    }
    for (const std::string& part : parts)
        if (part.empty())
            throw usageError(fmt::format("a model without a name in '{}'", name),
                             "models are added as in better_dipole+single");
    return parts;
}

Model sumOf(std::vector<Model> parts) {
    Model sum;
    BssrdfFile& file = sum.file;
    std::vector<std::string> ids, titles;
    for (const Model& part : parts) {
        if (std::ranges::find(ids, part.id) != ids.end())
            throw usageError(fmt::format("'{}' stands twice in a sum of models", part.id),
                             "each part has another name, by which its parameters are told apart");
        ids.push_back(part.id);
        titles.push_back(part.file.title);
    }
    sum.id = join(ids, "+");
    file.path = sum.id;
    file.title = join(titles, " + ");
    file.citation = gathered(parts, &BssrdfFile::citation);
    file.validity = gathered(parts, &BssrdfFile::validity);
    file.notes = gathered(parts, &BssrdfFile::notes);
    const auto all = [&](bool BssrdfFile::*attribute) {
        return std::ranges::all_of(parts, [&](const Model& part) { return part.file.*attribute; });
    };
    const auto any = [&](bool BssrdfFile::*attribute) {
        return std::ranges::any_of(parts, [&](const Model& part) { return part.file.*attribute; });
    };
    file.radial = all(&BssrdfFile::radial);
    file.no_wi = all(&BssrdfFile::no_wi);
    file.no_wo = all(&BssrdfFile::no_wo);
    file.reciprocal = all(&BssrdfFile::reciprocal);
    file.normals = any(&BssrdfFile::normals);
    file.single_scattering = any(&BssrdfFile::single_scattering);
    file.energy_violation = any(&BssrdfFile::energy_violation);
    file.grosjean = any(&BssrdfFile::grosjean);
    file.attributes = attributesOf(file);
    for (const Model& part : parts)
        for (Param param : part.file.parameters) {
            param.name = listedName(parts, part, param.name);
            file.parameters.push_back(std::move(param));
        }
    sum.shipped = std::ranges::all_of(parts, [](const Model& part) { return part.shipped || part.measured; });
    sum.parts = std::move(parts);
    return sum;
}

std::string parameterName(const Model& model, std::string_view given) {
    for (const Model& part : model.parts)
        for (const Param& param : part.file.parameters)
            if (given == qualified(part, param.name)) return listedName(model.parts, part, param.name);
    return std::string(given);
}

ParamValues partParameters(const Model& sum, const Model& part, const ParamValues& parameters) {
    ParamValues values;
    for (const Param& param : part.file.parameters) {
        const auto found = parameters.find(listedName(sum.parts, part, param.name));
        if (found != parameters.end()) values[param.name] = found->second;
    }
    return values;
}

std::string countedTwice(const Model& model) {
    std::vector<std::string> titles;
    for (const Model& part : model.parts)
        if (part.file.single_scattering) titles.push_back(part.file.title);
    if (titles.size() < 2) return {};
    return fmt::format("Single scattering is part of {}: it counts {} times.", join(titles, " and of "), titles.size());
}

}  // namespace searchlight
