#include "job/json.h"

#include "base/error.h"
#include "base/files.h"
#include "base/version.h"

namespace searchlight {

std::string jsonText(const Json& json, int indent) {
    return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

void writeOutput(JobResult& result, const std::function<void()>& write) {
    try {
        write();
    } catch (const Error& error) {
        if (error.kind != ErrorKind::input) throw;
        if (!result.failure.empty()) result.failure += '\n';
        result.failure += error.what();
    }
}

void writeDocument(JobResult& result, const Job& job) {
    if (!job.output.empty()) writeOutput(result, [&] { writeFile(job.output, result.json + "\n"); });
}

Json documentJson(std::string_view format, const Job& job) {
    Json document;
    document["format"] = format;
    document["version"] = version();
    document["job"] = Json::parse(jobJson(job));
    return document;
}

Json channelRows(std::span<const Rgb> values, const Medium& medium) {
    Json rows = Json::array();
    for (int c = 0; c < medium.channels; ++c) {
        Json row = Json::array();
        for (const Rgb& value : values) row.push_back(medium.scatters(c) ? Json(value[c]) : Json());
        rows.push_back(std::move(row));
    }
    return rows;
}

Json channelList(const Rgb& value, const Medium& medium) {
    Json list = Json::array();
    for (int c = 0; c < medium.channels; ++c) list.push_back(medium.scatters(c) ? Json(value[c]) : Json());
    return list;
}

Json subjectJson(const Subject& subject) {
    const Medium& medium = subject.medium;
    const auto list = [&](const Rgb& value) {
        Json json = Json::array();
        for (int c = 0; c < medium.channels; ++c) json.push_back(value[c]);
        return json;
    };
    Json json;
    json["id"] = subject.id;
    json["name"] = subject.name;
    json["source"] = subject.source;
    json["sigma_a"] = list(medium.sigma_a);
    json["sigma_s"] = list(medium.sigma_s);
    json["g"] = list(medium.g);
    json["eta"] = medium.eta;
    json["unit"] = "1/mm";
    Json not_applicable = Json::array();
    for (int c = 0; c < medium.channels; ++c)
        if (!medium.scatters(c)) not_applicable.push_back(c);
    if (!not_applicable.empty()) json["not_applicable"] = not_applicable;
    if (!subject.notes.empty()) json["notes"] = subject.notes;
    return json;
}

Json valueJson(const ParamValue& value) {
    return std::visit(
        []<class T>(const T& given) -> Json {
            if constexpr (std::is_same_v<T, Rgb>)
                return {given.r, given.g, given.b};
            else
                return given;
        },
        value);
}

Json paramJson(const Param& param) {
    constexpr std::string_view types[] = {"number", "integer", "bool",    "color",   "choice",
                                          "text",   "path",    "numbers", "channels"};
    Json json;
    json["name"] = param.name;
    json["type"] = types[static_cast<int>(param.type)];
    if (!param.unit.empty()) json["unit"] = param.unit;
    if (param.min != 0 || param.max != 0) {
        json["min"] = param.min;
        json["max"] = param.max;
    }
    if (!param.choices.empty()) json["choices"] = param.choices;
    if (param.required)
        json["required"] = true;
    else
        json["default"] = valueJson(param.value);
    if (!param.doc.empty()) json["doc"] = param.doc;
    return json;
}

}  // namespace searchlight
