// convert: a material in the words of other programs.
#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "base/text.h"
#include "job/command_table.h"
#include "job/json.h"
#include "job/shared_options.h"
#include "model/convention/convention.h"
#include "scene/materials.h"

namespace searchlight {

namespace {

constexpr const char* table_name = "material";

// Every key of every convention, once, as an option.
std::vector<Param> keyOptions() {
    std::vector<Param> options;
    for (const Convention& convention : conventions())
        for (const ConventionKey& key : convention.keys) {
            const auto known = std::ranges::find(options, key.param.name, &Param::name);
            if (known != options.end()) {
                known->doc += ", " + convention.id;
                continue;
            }
            options.push_back({.name = key.param.name,
                               .type = ParamType::channels,
                               .min = -option::unlimited,
                               .max = option::unlimited,
                               .value = std::vector<double>{},
                               .doc = "value of " + convention.id});
        }
    return options;
}

// What --from says when it is no convention: "material", or the beginning of a table's name, such as "jensen".
bool isTable(std::string_view name) {
    return name == table_name || (!name.empty() && std::ranges::any_of(materials(), [&](const Material& material) {
               return material.source.starts_with(name);
           }));
}

Material materialOf(const std::string& table, const std::string& id) {
    if (table == table_name || id.find(':') != std::string::npos) return findMaterial(id);
    for (const Material& material : materials())
        if (material.source.starts_with(table)) return findMaterial(material.source + ":" + id);
    return findMaterial(id);
}

struct Source {
    std::string name, text;
    Medium medium;
    std::vector<std::string> notes;
};

Source sourceOf(const Options& options, const ConventionContext& context) {
    const std::string& from = options.text("from");
    ConventionValues given;
    for (const Param& param : keyOptions())
        if (options.given(param.name)) given[param.name] = options.list(param.name);
    if (isTable(from)) {
        if (!given.empty())
            throw usageError(fmt::format("--from {} takes no '{}'", from, given.begin()->first),
                             "it takes --material; --from CONVENTION takes the convention's values");
        const Material material = materialOf(from, options.text("material"));
        Source source{material.id, fmt::format("{} ({})", material.name, material.source), material.medium, {}};
        if (!material.unit_known) source.notes.push_back("its table does not state its unit: taken as 1/mm");
        return source;
    }
    if (options.given("material"))
        throw usageError(fmt::format("--from {} takes no --material", from), "leave out --from, or the material");
    const Convention& convention = findConvention(from);
    return {convention.id, convention.title, readConvention(convention, given, context), {}};
}

// A number, or a list of them; null for what there is none of.
Json numbersJson(const ConventionKey& key, const std::vector<double>& numbers) {
    const auto number = [](double value) { return std::isfinite(value) ? Json(value) : Json(); };
    if (key.param.type != ParamType::channels) return number(numbers.front());
    Json list = Json::array();
    for (const double value : numbers) list.push_back(number(value));
    return list;
}

std::string numbersText(const std::vector<double>& numbers) {
    std::vector<std::string> parts;
    for (const double value : numbers)
        parts.push_back(std::isfinite(value) ? prettyNumber(value, 6) : std::string("n/a"));
    return join(parts, ", ");
}

Json conventionJson(const Convention& convention, const WrittenConvention& written, double read_back_error) {
    Json json{{"convention", convention.id},
              {"title", convention.title},
              {"source", convention.source},
              {"relation", convention.relation}};
    for (const ConventionKey& key : convention.keys) {
        const auto found = written.values.find(key.param.name);
        if (found == written.values.end()) continue;
        json["values"][key.param.name] = {{"value", numbersJson(key, found->second)},
                                          {"unit", key.param.unit.empty() ? "1" : key.param.unit},
                                          {"meaning", key.meaning}};
    }
    json["notes"] = written.notes;
    json["read_back_error"] = std::isfinite(read_back_error) ? Json(read_back_error) : Json();
    return json;
}

std::string conventionText(const Convention& convention, const WrittenConvention& written) {
    std::string text = fmt::format("\n{}: {}\n", convention.id, convention.title);
    for (const ConventionKey& key : convention.keys) {
        const auto found = written.values.find(key.param.name);
        if (found == written.values.end()) continue;
        const std::string unit = key.param.unit.empty() ? "" : " " + key.param.unit;
        text += fmt::format("  {:<28} {:<34} {}\n", key.param.name, numbersText(found->second) + unit, key.meaning);
    }
    text += fmt::format("  by: {}\n", convention.relation);
    for (const std::string& note : written.notes) text += fmt::format("  note: {}\n", note);
    return text;
}

JobResult runConvert(const Job& job, Engine& engine, Observer& observer) {
    const Options options(job);
    ConventionContext context;
    context.unit_mm = options.number("unit_mm");
    context.width = options.text("width") == "searchlight" ? BurleyWidth::searchlight
                    : options.text("width") == "diffuse"   ? BurleyWidth::diffuse
                                                           : BurleyWidth::diffuse_mean_free_path;
    Medium any;
    any.sigma_a = any.sigma_s = {1, 1, 1};
    const LoadedModel loaded = engine.load(options.text("model"), options.names("set"), options.text("backend"), any);
    context.evaluator = loaded.evaluator.get();
    context.model = &loaded.model;
    context.parameters = loaded.parameters;

    std::vector<const Convention*> wanted;
    for (const std::string& name : options.names("to"))
        if (name == "all")
            for (const Convention& convention : conventions()) wanted.push_back(&convention);
        else
            wanted.push_back(&findConvention(name));
    if (wanted.empty()) throw usageError("--to names no convention", "such as --to cycles,openpbr, or all");

    const Source source = sourceOf(options, context);
    for (const std::string& note : source.notes) observer.log(LogLevel::warning, note);
    const Medium& medium = source.medium;
    Json document = documentJson("searchlight-conversion/1", job);
    document["from"] = source.name;
    document["medium"] = {{"sigma_a", channelList(medium.sigma_a, medium)},
                          {"sigma_s", channelList(medium.sigma_s, medium)},
                          {"g", channelList(medium.g, medium)},
                          {"eta", medium.eta},
                          {"unit", "1/mm"}};
    document["to"] = Json::array();
    JobResult result;
    result.text = fmt::format("{}\n", source.text);
    for (const Convention* convention : wanted) {
        const WrittenConvention written = writeConvention(*convention, medium, context);
        document["to"].push_back(
            conventionJson(*convention, written, readBackError(*convention, medium, written, context)));
        result.text += conventionText(*convention, written);
    }
    result.json = jsonText(document);
    writeDocument(result, job);
    return result;
}

}  // namespace

Command convertCommand() {
    std::vector<Param> options{{.name = "from",
                                .type = ParamType::text,
                                .value = std::string(table_name),
                                .doc = "what the input is in: a convention, material, or a table such as jensen"},
                               {.name = "to",
                                .type = ParamType::text,
                                .value = std::string("all"),
                                .doc = "conventions separated by commas, or all"},
                               {.name = "material",
                                .type = ParamType::text,
                                .value = std::string("skin1"),
                                .doc = "a measured material: its id, source:id or table.csv:id"},
                               {.name = "unit_mm",
                                .unit = "mm",
                                .min = 0,
                                .max = option::unlimited,
                                .value = 1.0,
                                .doc = "length of a scene unit: 10 for centimetres, 1000 for metres",
                                .exclusive = true},
                               {.name = "width",
                                .type = ParamType::choice,
                                .value = std::string("diffuse_mean_free_path"),
                                .choices = {"searchlight", "diffuse", "diffuse_mean_free_path"},
                                .doc = "Eq. 5, 6 or 8 of Christensen and Burley, for burley, unity and cycles_burley"},
                               option::model(),
                               option::set(),
                               option::backend()};
    options[5].doc += ", for Rdr and ld";
    for (Param& key : keyOptions()) options.push_back(std::move(key));
    return {.name = "convert",
            .summary = "Say a material in the words of renderers and artists",
            .example = "searchlight convert --from jensen --material skin1 --to cycles,unreal,openpbr --unit-mm 1000",
            .options = std::move(options),
            .output = "the JSON document",
            .run = runConvert};
}

}  // namespace searchlight
