#include "job/contest/contest_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <set>

#include "base/error.h"
#include "base/text.h"
#include "job/command_table.h"
#include "job/picture_options.h"
#include "job/render/kept_renderer.h"

namespace searchlight {

namespace {

constexpr std::string_view every_technique = "all";
// Some hundred pictures of that size are compared: more is a slip of the pen.
constexpr double most_pixels = 4e6;

// Not from commands(), which is being made where the contest's own options are.
const std::vector<Param>& renderOptions() {
    static const std::vector<Param> options = renderCommand().options;
    return options;
}

// "direct:sampling=area:pass_points=4096".
struct Wanted {
    const TechniqueEntry* entry = nullptr;
    ParamValues options;
    bool by_name = false;
};

Wanted parseWanted(const std::string& text) {
    const std::vector<std::string_view> parts = split(text, ':');
    Wanted wanted{.entry = &findTechnique(trim(parts.front())), .by_name = true};
    for (std::size_t i = 1; i < parts.size(); ++i) {
        const std::size_t equals = parts[i].find('=');
        if (equals == std::string_view::npos)
            throw usageError(fmt::format("'{}' is no option of a technique", parts[i]), "such as direct:sampling=area");
        std::string name(trim(parts[i].substr(0, equals)));
        std::ranges::replace(name, '-', '_');
        const auto own = std::ranges::find(wanted.entry->options, name, &Param::name);
        if (own == wanted.entry->options.end() && name != "points") {
            std::vector<std::string> names;
            for (const Param& param : wanted.entry->options) names.push_back(param.name);
            if (wanted.entry->light_at == LightPlace::points) names.emplace_back("points");
            throw unknownName(ErrorKind::usage, fmt::format("option of {}", wanted.entry->id), name, names);
        }
        wanted.options[name] = parseValue(findParam(renderOptions(), name, "option"), parts[i].substr(equals + 1));
    }
    return wanted;
}

std::vector<Wanted> wantedTechniques(const std::vector<std::string>& texts) {
    std::vector<Wanted> wanted;
    for (const std::string& text : texts) {
        if (text != every_technique) {
            wanted.push_back(parseWanted(text));
            continue;
        }
        for (const TechniqueEntry& entry : techniques()) wanted.push_back({.entry = &entry});
    }
    if (wanted.empty()) throw usageError("no technique is asked for", "such as --techniques hierarchical,direct");
    return wanted;
}

double budgetNumber(std::string_view text) {
    const std::optional<double> number = parseNumber(trim(text));
    if (!number || *number <= 0) throw usageError(fmt::format("'{}' is no budget", text), "a number above 0");
    return *number;
}

// By technique; and how many of each ladder otherwise.
struct Budgets {
    std::map<std::string, std::vector<double>, std::less<>> given;
    std::size_t most = 1000;
};

Budgets parseBudgets(const std::vector<std::string>& texts) {
    Budgets budgets;
    for (const std::string& text : texts) {
        if (text == "auto") continue;
        const std::size_t equals = text.find('=');
        if (equals != std::string::npos) {
            const TechniqueEntry& entry = findTechnique(trim(std::string_view(text).substr(0, equals)));
            std::vector<double>& values = budgets.given[std::string(entry.id)];
            for (const std::string_view value : split(std::string_view(text).substr(equals + 1), ':'))
                values.push_back(budgetNumber(value));
            continue;
        }
        const std::optional<double> count = parseNumber(text);
        if (!count || *count != std::floor(*count) || *count < 1 || *count > 100)
            throw usageError(fmt::format("'{}' is no value for budgets", text),
                             "auto, how many of each technique's, or such as direct=16:64:256");
        budgets.most = static_cast<std::size_t>(*count);
    }
    return budgets;
}

// For the name of a file.
std::string plain(const std::string& text) {
    std::string result = text;
    for (char& c : result)
        if (!std::isalnum(static_cast<unsigned char>(c)) && c != '.' && c != '-' && c != '_') c = '-';
    return result;
}

std::vector<double> laddersOf(const Wanted& wanted, const Budgets& budgets) {
    const Budget& budget = wanted.entry->budget;
    // What is set is no budget any more.
    if (budget.option.empty() || wanted.options.contains(budget.option)) return {0};
    if (const auto given = budgets.given.find(wanted.entry->id); given != budgets.given.end()) return given->second;
    std::vector<double> values = budget.values;
    values.resize(std::min(values.size(), budgets.most));
    return values;
}

Contestant contestantOf(const Wanted& wanted, bool gl, const Budgets& budgets, const Job& picture) {
    Contestant contestant{.label = std::string(wanted.entry->id), .entry = wanted.entry, .gl = gl};
    std::string stem(wanted.entry->id);
    for (const auto& [name, value] : wanted.options) {
        contestant.label += fmt::format(", {} {}", name, valueText(value));
        stem += plain(fmt::format("_{}-{}", name, valueText(value)));
    }
    stem += gl ? "_gl" : "_cpu";
    for (const double value : laddersOf(wanted, budgets)) {
        ContestCell cell{.budget = value, .stem = stem, .job = picture};
        cell.job.options["technique"] = std::string(wanted.entry->id);
        for (const auto& [name, fixed] : wanted.options) cell.job.options[name] = fixed;
        if (value > 0) {
            const std::string option(wanted.entry->budget.option);
            cell.job.options[option] = parseValue(findParam(renderOptions(), option, "option"), numberText(value));
            cell.budget_text = fmt::format("{} {}", option, numberText(value));
            cell.stem += "_" + plain(numberText(value));
        }
        cell.job.options["backend"] = std::string(gl ? "gl" : "auto");
        renderSettings(cell.job);
        contestant.cells.push_back(std::move(cell));
    }
    return contestant;
}

std::string whyNot(const TechniqueEntry& entry, const Wanted& wanted, bool radial) {
    const auto beam = wanted.options.find(normal_beam_option);
    const bool taken = radial || (beam != wanted.options.end() && std::get<bool>(beam->second));
    if (!taken && !entry.directional) return "it takes radial models, and this one reads directions";
    return {};
}

Scene strippedScene(Scene scene) {
    scene.coat.reset();
    scene.ground.reset();
    scene.backdrop = Rgb{0, 0, 0};
    return scene;
}

}  // namespace

const std::vector<Param>& contestPictureOptions() {
    static const std::vector<Param> options = [] {
        std::vector<Param> taken;
        for (const char* name : {"size", "points", "edge_samples", "light_samples", "threads"})
            taken.push_back(findParam(renderOptions(), name, "option"));
        taken.front().value = std::string("320x240");
        return taken;
    }();
    return options;
}

ContestPlan contestPlan(const Job& job, bool radial) {
    const Options options(job);
    ContestPlan plan;
    plan.scene = strippedScene(job.scene);
    if (plan.scene.lights.empty()) throw usageError("a contest needs light", "such as --light dir:1,1,1");
    const PictureSize size = parsePictureSize(options.text("size"));
    plan.width = size.width;
    plan.height = size.height;
    if (1.0 * size.width * size.height > most_pixels)
        throw usageError(fmt::format("{} x {} pixels are too many for a contest", size.width, size.height),
                         fmt::format("at most {} million", most_pixels / 1e6));
    Job picture;
    picture.command = "render";
    picture.scene = plan.scene;
    picture.seed = job.seed;
    for (const Param& param : contestPictureOptions()) picture.options[param.name] = valueOf(param, job.options);
    picture.options["cache"] = std::string("none");

    const Budgets budgets = parseBudgets(options.names("budgets"));
    const std::vector<std::string> backends = options.names("backend");
    for (const std::string& backend : backends)
        if (backend != "cpu" && backend != "gl") throw unknownName(ErrorKind::usage, "backend", backend, {"cpu", "gl"});
    if (backends.empty()) throw usageError("no backend is asked for", "--backend cpu, gl or cpu,gl");
    std::set<std::string> stems;
    std::size_t color = 0;
    for (const Wanted& wanted : wantedTechniques(options.names("techniques"))) {
        if (const std::string why = whyNot(*wanted.entry, wanted, radial); !why.empty()) {
            if (wanted.by_name)
                throw usageError(fmt::format("{} cannot take part: {}", wanted.entry->id, why),
                                 fmt::format("--techniques {}:normal_beam=true takes its mean", wanted.entry->id));
            plan.left_out.emplace_back(wanted.entry->id, why);
            continue;
        }
        bool taken = false;
        for (const std::string& backend : backends) {
            const bool gl = backend == "gl";
            if (gl && !wanted.entry->gl) continue;
            Contestant contestant = contestantOf(wanted, gl, budgets, picture);
            contestant.color = color;
            for (std::size_t i = 0; i < contestant.cells.size(); ++i) {
                contestant.cells[i].contestant = plan.contestants.size();
                if (!stems.insert(contestant.cells[i].stem).second)
                    throw usageError(fmt::format("{} takes part twice with the same budget", contestant.label));
            }
            plan.contestants.push_back(std::move(contestant));
            taken = true;
        }
        if (!taken) plan.left_out.emplace_back(wanted.entry->id, "it has no version on OpenGL");
        color += taken;
    }
    if (plan.contestants.empty()) throw usageError("no technique can take part", plan.left_out.front().second);
    return plan;
}

}  // namespace searchlight
