#include "job/reference/saved_walks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <span>

#include "base/error.h"
#include "base/files.h"
#include "base/ranks.h"
#include "base/text.h"
#include "base/version.h"
#include "scene/json_text.h"

namespace searchlight {

namespace {

constexpr std::string_view format_name = "searchlight-walks/";
constexpr std::string_view format = "searchlight-walks/1";

// "0.5%" or "0.005"; 0 for no text.
double parseFraction(const std::string& text) {
    if (text.empty()) return 0;
    const bool percent = text.ends_with('%');
    const std::optional<double> number = parseNumber(text.substr(0, text.size() - (percent ? 1 : 0)));
    const double value = number ? *number / (percent ? 100 : 1) : 0;
    if (!(value > 0 && value < 1))
        throw usageError(fmt::format("'{}' is no value for until_error", text), "a fraction such as 0.5% or 0.005");
    return value;
}

// The path of the first value that differs, as a JSON pointer.
std::optional<std::string> difference(const Json& a, const Json& b, const std::string& pointer) {
    if (a.type() == b.type() && a.is_object()) {
        for (const auto& [key, value] : a.items()) {
            const std::string place = pointer + pointerStep(key);
            if (!b.contains(key)) return place;
            if (const auto found = difference(value, b.at(key), place)) return found;
        }
        for (const auto& [key, value] : b.items())
            if (!a.contains(key)) return pointer + pointerStep(key);
        return std::nullopt;
    }
    return a == b ? std::nullopt : std::optional(pointer);
}

// A whole number that double holds exactly.
std::uint64_t count(const JsonText& text, const std::string& pointer, const nlohmann::json& json, double least) {
    const Param whole{.name = pointer, .type = ParamType::integer, .min = least, .max = 9007199254740992.0};
    return static_cast<std::uint64_t>(std::get<double>(text.value(pointer, json, whole)));
}

const nlohmann::json& member(const JsonText& text, const std::string& pointer, const nlohmann::json& object,
                             const char* key) {
    if (!object.is_object() || !object.contains(key))
        throw text.error(pointer, fmt::format("'{}' is missing", key), "a file that --resume wrote");
    return object.at(key);
}

WalkState readState(const JsonText& text, const std::string& pointer, const nlohmann::json& json) {
    WalkState state;
    const auto at = [&](const char* key) -> const nlohmann::json& { return member(text, pointer, json, key); };
    state.chunk_size = count(text, pointer + "/chunk_size", at("chunk_size"), 1);
    state.chunks = count(text, pointer + "/chunks", at("chunks"), 0);
    state.walks = count(text, pointer + "/walks", at("walks"), 0);
    if (state.chunks == 0 ? state.walks != 0 : state.walks < std::max(state.chunks, state.chunk_size))
        throw text.error(pointer + "/walks", "does not fit the number of chunks", "a file that --resume wrote");
    state.collisions = count(text, pointer + "/collisions", at("collisions"), 0);
    const nlohmann::json& seconds = at("seconds");
    if (!seconds.is_number() || !(seconds.get<double>() >= 0))
        throw text.error(pointer + "/seconds", "is no time", "seconds, 0 or more");
    state.seconds = seconds.get<double>();
    const nlohmann::json& sums = at("sums");
    if (!sums.is_array()) throw text.error(pointer + "/sums", "is no list", "a file that --resume wrote");
    for (std::size_t i = 0; i < sums.size(); ++i) {
        const std::string place = fmt::format("{}/sums/{}", pointer, i);
        if (!sums[i].is_array() || sums[i].size() < 3 || sums[i].size() % 3 != 0)
            throw text.error(place, "is no list of sums", "a file that --resume wrote");
        std::vector<double> values;
        for (const nlohmann::json& value : sums[i]) {
            if (!value.is_number() || !std::isfinite(value.get<double>()))
                throw text.error(place, "holds what is no number", "a file that --resume wrote");
            values.push_back(value.get<double>());
        }
        if (values[0] != static_cast<double>(state.chunks))
            throw text.error(place, "does not have as many batches as the walk has chunks",
                             "a file that --resume wrote");
        if (i == 0 && values[1] != static_cast<double>(state.walks))
            throw text.error(place, "is not of as many walks as the file says", "a file that --resume wrote");
        BatchRatios ratios(values.size() / 3 - 1);
        ratios.unpack(values);
        state.sums.push_back(std::move(ratios));
    }
    return state;
}

Json stateJson(const WalkState& state) {
    if (state.empty()) return nullptr;
    Json json{{"chunk_size", state.chunk_size},
              {"chunks", state.chunks},
              {"walks", state.walks},
              {"collisions", state.collisions},
              {"seconds", state.seconds}};
    json["sums"] = Json::array();
    for (const BatchRatios& sums : state.sums) json["sums"].push_back(sums.pack());
    return json;
}

}  // namespace

SavedWalks::SavedWalks(const Options& options, const Job& job, Json problem, std::size_t states, Observer& observer)
    : path_(options.text("resume")),
      observer_(observer),
      problem_(std::move(problem)),
      until_error_(parseFraction(options.text("until_error"))),
      keeps_(!path_.empty() || !job.output.empty() || rankCount() > 1),
      states_(states) {
    problem_["command"] = job.command;
    problem_["seed"] = job.seed;
    if (path_.empty()) return;
    try {
        if (std::error_code error; rank() == 0 && std::filesystem::exists(path_, error)) read();
        if (rank() == 0) checkWritable(path_);
    } catch (const Error&) {
        shareFromFirst({});
        throw;
    }
    if (rankCount() > 1) share();
}

void SavedWalks::read() {
    const JsonText text(readFile(path_, std::size_t{1} << 32), path_);
    const std::string name = member(text, "", text.root(), "format").is_string()
                                 ? text.root().at("format").get<std::string>()
                                 : std::string();
    if (name != format)
        throw text.error("/format", fmt::format("'{}' cannot be read", name),
                         name.starts_with(format_name) ? "a newer version wrote it" : "a file that --resume wrote");
    const nlohmann::json& root = text.root();
    if (!root.contains("estimators") || root.at("estimators") != kWalkVersion)
        throw text.error(root.contains("estimators") ? "/estimators" : "",
                         "these are walks by another version of the estimators: their sums do not go on",
                         "give another file, and walk anew");
    const Json there = Json::parse(member(text, "", text.root(), "problem").dump());
    // Keys in the order of the file's reader: members of lists are compared whole.
    const Json here = Json::parse(nlohmann::json::parse(jsonText(problem_)).dump());
    if (const auto place = difference(here, there, ""))
        throw text.error(!there.contains(Json::json_pointer(*place)) ? "/problem" : "/problem" + *place,
                         fmt::format("these are walks of another problem: {} differs", place->empty() ? "it" : *place),
                         "resume the same problem, or give another file");
    const nlohmann::json& states = member(text, "", text.root(), "states");
    if (!states.is_array() || states.size() != states_.size())
        throw text.error("/states", fmt::format("should hold {} walks", states_.size()), "a file that --resume wrote");
    for (std::size_t i = 0; i < states_.size(); ++i)
        if (!states[i].is_null()) states_[i] = readState(text, fmt::format("/states/{}", i), states[i]);
}

// The others may be on machines that do not have the file.
void SavedWalks::share() {
    const auto number = [](std::uint64_t count) { return static_cast<double>(count); };
    std::vector<double> values{1};
    for (const WalkState& state : states_) {
        values.insert(values.end(), {number(state.chunk_size), number(state.chunks), number(state.walks),
                                     number(state.collisions), state.seconds, number(state.sums.size())});
        for (const BatchRatios& sums : state.sums) {
            const std::vector<double> packed = sums.pack();
            values.push_back(number(packed.size()));
            values.insert(values.end(), packed.begin(), packed.end());
        }
    }
    values = shareFromFirst(values);
    if (values.empty()) throw inputError(fmt::format("{} was not read by the first process", path_));
    if (rank() == 0) return;
    std::span<const double> rest = std::span<const double>(values).subspan(1);
    const auto take = [&](std::size_t count) {
        const std::span<const double> taken = rest.first(count);
        rest = rest.subspan(count);
        return taken;
    };
    const auto whole = [&] { return static_cast<std::uint64_t>(take(1).front()); };
    for (WalkState& state : states_) {
        state.chunk_size = whole();
        state.chunks = whole();
        state.walks = whole();
        state.collisions = whole();
        state.seconds = take(1).front();
        state.sums.clear();
        for (std::uint64_t left = whole(); left > 0; --left) {
            const std::span<const double> packed = take(static_cast<std::size_t>(whole()));
            state.sums.emplace_back(packed.size() / 3 - 1).unpack(packed);
        }
    }
}

WalkControl SavedWalks::control(std::size_t i) {
    WalkControl control;
    control.until_error = until_error_;
    control.share = true;
    if (!keeps_) return control;
    control.state = &states_[i];
    control.file = path_;
    if (!path_.empty())
        control.save = [this, i](const WalkState& state) {
            states_[i] = state;
            try {
                write();
            } catch (const Error& error) {  // the disk may have room again when all is walked
                observer_.log(LogLevel::warning, error.what());
            }
        };
    return control;
}

void SavedWalks::save(JobResult& result) const {
    writeOutput(result, [this] { write(); });
}

void SavedWalks::write() const {
    if (path_.empty() || rank() != 0) return;
    Json json{{"format", format}, {"version", version()}, {"estimators", kWalkVersion}};
    json["problem"] = problem_;
    json["states"] = Json::array();
    for (const WalkState& state : states_) json["states"].push_back(stateJson(state));
    writeFile(path_, jsonText(json, -1) + "\n");
}

}  // namespace searchlight
