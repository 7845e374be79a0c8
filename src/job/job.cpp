#include "job/job.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/error.h"
#include "base/files.h"
#include "base/ranks.h"
#include "base/text.h"
#include "job/command.h"
#include "job/json.h"
#include "model/sum_model.h"
#include "scene/json_text.h"

namespace searchlight {

namespace {

constexpr std::string_view format_name = "searchlight-job/";
constexpr int format_version = 1;
constexpr double largest_exact_integer = 9007199254740992.0;  // 2^53: above it a JSON number is no longer exact

void checkFormat(const JsonText& text) {
    const nlohmann::json& root = text.root();
    if (!root.is_object()) throw text.error("", "a job is a JSON object", "{\"format\": \"searchlight-job/1\", ...}");
    const auto format = root.find("format");
    if (format == root.end()) throw text.error("", "no format", "expected \"format\": \"searchlight-job/1\"");
    const std::string name = format->is_string() ? format->get<std::string>() : format->dump();
    if (name == fmt::format("{}{}", format_name, format_version)) return;
    if (!name.starts_with(format_name))
        throw text.error("/format", fmt::format("'{}' is no job", name), "expected searchlight-job/1");
    const std::optional<double> version = parseNumber(std::string_view(name).substr(format_name.size()));
    if (version && *version > format_version)
        throw text.error("/format", fmt::format("'{}' is newer than this program", name), "it reads searchlight-job/1");
    throw text.error("/format", fmt::format("unknown version '{}'", name), "expected searchlight-job/1");
}

ParamValues parseOptions(const JsonText& text, const nlohmann::json& options, const Command& command) {
    if (!options.is_object()) throw text.error("/options", "expected an object");
    ParamValues values;
    for (const auto& [name, value] : options.items()) {
        const std::string pointer = "/options" + pointerStep(name);
        const Param* param = nullptr;
        try {
            param = &findParam(command.options, name, fmt::format("option of {}", command.name));
        } catch (const Error& unknown) {
            throw text.errorAtKey(pointer, unknown.message, unknown.hint);
        }
        values[name] = text.value(pointer, value, *param);
    }
    for (const Param& param : command.options)
        if (param.required && !values.contains(param.name))
            throw text.error("/options", fmt::format("{} needs '{}'", command.name, param.name), param.doc);
    return values;
}

// What would be found out only after the work.
void checkOutput(const Job& job, const Command& command) {
    if (job.output.empty() || command.writes_folder) return;
    for (const Param& param : command.options) {
        const auto given = job.options.find(param.name);
        if (command.shares_walks && param.type == ParamType::path && given != job.options.end() &&
            sameFile(std::get<std::string>(given->second), job.output))
            throw usageError(fmt::format("-o would write over the file of --{}", param.name), "give another name");
    }
    checkWritable(job.output);
}

}  // namespace

Job parseJob(std::string_view source, std::string_view path) {
    const JsonText text(source, path);
    checkFormat(text);
    const nlohmann::json& root = text.root();
    static const std::vector<std::string> keys{"format", "command", "scene", "options", "seed", "output", "window"};
    for (const auto& [key, value] : root.items())
        if (std::ranges::find(keys, key) == keys.end()) {
            const Error unknown = unknownName(ErrorKind::input, "key", key, keys);
            throw text.errorAtKey(pointerStep(key), unknown.message, unknown.hint);
        }
    const auto need = [&](const char* key, bool fits, std::string_view expected) {
        if (!fits)
            throw text.error(std::string("/") + key, fmt::format("{} is no {}", root[key].dump(), key),
                             std::string(expected));
    };
    Job job;
    if (!root.contains("command")) throw text.error("", "no command", "such as \"command\": \"profile\"");
    need("command", root["command"].is_string(), "expected a command's name");
    job.command = root["command"];
    const Command* command = nullptr;
    try {
        command = &findCommand(job.command);
    } catch (const Error& unknown) {
        throw text.error("/command", unknown.message, unknown.hint);
    }
    if (root.contains("scene")) job.scene = readScene(text, "/scene");
    job.options = parseOptions(text, root.value("options", nlohmann::json::object()), *command);
    if (root.contains("seed")) {
        const nlohmann::json& seed = root["seed"];
        const bool fits = seed.is_number() && seed.get<double>() >= 0 && seed.get<double>() <= largest_exact_integer &&
                          seed.get<double>() == std::floor(seed.get<double>());
        need("seed", fits, "expected a whole number from 0 to 2^53");
        job.seed = static_cast<std::uint64_t>(seed.get<double>());
    }
    if (root.contains("output")) {
        need("output", root["output"].is_string(), "expected a path");
        job.output = root["output"];
    }
    if (root.contains("window")) {
        need("window", root["window"].is_object(), "expected an object");
        job.window = root["window"].dump();
    }
    return job;
}

std::string jobJson(const Job& job) {
    Json json;
    json["format"] = fmt::format("{}{}", format_name, format_version);
    json["command"] = job.command;
    const Command& command = findCommand(job.command);
    if (command.uses_scene) json["scene"] = Json::parse(sceneJson(job.scene));
    if (command.uses_material) {
        // What the command does not read stays out: the file says what matters.
        const Json scene = Json::parse(sceneJson(job.scene));
        json["scene"] = {{"format", scene["format"]}, {"material", scene["material"]}};
        if (job.scene.material.inverted()) json["scene"]["model"] = scene["model"];
    }
    json["options"] = Json::object();
    for (const Param& param : command.options)
        if (const auto given = job.options.find(param.name); given != job.options.end())
            json["options"][param.name] = valueJson(given->second);
    if (command.uses_seed) json["seed"] = job.seed;
    if (!job.output.empty()) json["output"] = job.output;
    if (!job.window.empty()) json["window"] = Json::parse(job.window);
    return jsonText(json);
}

JobResult run(const Job& job, Observer& observer) {
    Engine engine;
    return run(job, engine, observer);
}

JobResult run(const Job& job, Engine& engine, Observer& observer) {
    const Command& command = findCommand(job.command);
    if (rank() == 0) checkOutput(job, command);
    if (rank() == 0 || command.writes_in_parts) return command.run(job, engine, observer);
    if (!command.shares_walks) return {};
    Job share = job;  // the process with rank 0 writes
    share.output.clear();
    return command.run(share, engine, observer);
}

std::vector<std::string> modelFiles(const Job& job) {
    std::vector<std::string> files;
    const auto add = [&](std::string_view model) {
        for (std::string& part : partNames(model))
            if (std::error_code error; std::filesystem::is_regular_file(part, error)) files.push_back(std::move(part));
    };
    if (findCommand(job.command).uses_scene) add(job.scene.model.id);
    for (const char* option : {"model", "models", "solo"}) {
        const auto given = job.options.find(option);
        if (given == job.options.end()) continue;
        for (const std::string_view name : split(std::get<std::string>(given->second), ','))
            add(trim(name.substr(0, name.find(':'))));
    }
    return files;
}

}  // namespace searchlight
