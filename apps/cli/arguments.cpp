#include "arguments.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <map>

#include "base/error.h"
#include "base/files.h"
#include "base/text.h"
#include "base/version.h"
#include "job/command.h"
#include "job/engine.h"
#include "model/model.h"
#include "scene_flags.h"

namespace searchlight {

namespace {

std::string flagOf(std::string_view name) {
    std::string flag = "--" + std::string(name);
    std::ranges::replace(flag, '_', '-');
    return flag;
}

// "number from 0 to 1 1/mm; default 0.5": what stands behind an option in --help.
std::string describe(const Param& param) {
    std::string text = param.doc;
    if (param.type == ParamType::choice)
        text += ": " + join(param.choices, ", ");
    else if (!param.unit.empty())
        text += fmt::format(" [{}]", param.unit);
    const std::string value = valueText(param.value);
    if (!param.required && !value.empty()) text += fmt::format(" (default {})", value);
    return text;
}

bool isPositional(const Command& command, const Param& param) {
    const std::vector<std::string_view> names = split(command.positional, ' ');
    return std::ranges::find(names, param.name) != names.end();
}

// The arguments of one subcommand as they were typed.
struct Typed {
    const Command* command = nullptr;
    CLI::App* app = nullptr;
    std::map<std::string, std::vector<std::string>, std::less<>> options;   // of the command
    std::map<std::string, std::vector<std::string>, std::less<>> material;  // of the scene's material
    TypedFlags scene_flags;                                                 // of the rest of the scene
    std::string scene, seed, output;
};

struct MaterialFlag {
    const char* name;
    const char* doc;
};

constexpr MaterialFlag material_flags[] = {
    {"material", "a measured material: its id, source:id or table.csv:id (default skin1)"},
    {"sigma_a", "absorption coefficient: one number or R,G,B [1/mm]"},
    {"sigma_s", "scattering coefficient, not reduced [1/mm]"},
    {"g", "mean cosine of the phase function (default 0)"},
    {"eta", "refractive index, inside over outside (default 1.3)"},
    {"Rdr", "total diffuse reflectance, inverted by --model or the dipole, with --ld"},
    {"ld", "diffuse mean free path [mm]"},
    {"inverted_by", "what inverts Rdr and ld, as better_dipole:Moments=exact (default --model, or the dipole)"},
    {"material_scale", "lengths of the medium times this, coefficients divided by it (default 1)"},
};

CLI::Option* addOption(CLI::App& app, const std::string& name, std::vector<std::string>& into, const std::string& doc,
                       const std::string& group = "Options") {
    return app.add_option(name, into, doc)
        ->group(group)
        ->type_name("")
        ->type_size(1)
        ->expected(1)
        ->allow_extra_args(false)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

// The subcommand at the end of the words of `name`, made where it is missing.
CLI::App& subcommand(CLI::App& root, const Command& command) {
    CLI::App* app = &root;
    const std::vector<std::string_view> words = split(command.name, ' ');
    for (std::size_t i = 0; i < words.size(); ++i) {
        const std::string word(words[i]);
        const bool last = i + 1 == words.size();
        const std::vector<CLI::App*> same =
            app->get_subcommands([&](const CLI::App* sub) { return sub->get_name() == word; });
        CLI::App* next = same.empty() ? nullptr : same.front();
        if (!next) next = app->add_subcommand(word, last ? std::string(command.summary) : "One of");
        next->allow_extras();
        // A second command is none: `reference mesh sphere` reads an object, not the command beside it.
        next->require_subcommand(0, 1);
        if (!last)
            next->description(next->get_description() + (next->get_subcommands(nullptr).empty() ? ": " : ", ") +
                              std::string(words[i + 1]));
        app = next;
    }
    return *app;
}

void declare(CLI::App& root, Typed& typed, Arguments& arguments) {
    const Command& command = *typed.command;
    CLI::App& app = subcommand(root, command);
    typed.app = &app;
    app.footer("Example:\n  " + std::string(command.example));
    for (const Param& param : command.options) {
        std::string names = flagOf(param.name);
        if (isPositional(command, param)) names += "," + param.name;
        if (param.letter) names = fmt::format("-{},{}", param.letter, names);
        CLI::Option* option = addOption(app, names, typed.options[param.name], describe(param));
        if (param.type == ParamType::toggle) option->expected(0, 1);
    }
    if (command.uses_scene) {
        app.add_option("--scene", typed.scene, "a scene file, which the flags change")->type_name("")->group("Scene");
        for (const SceneFlag& flag : sceneFlags()) {
            std::string names = flagOf(flag.name);
            if (flag.name == "object") names += ",object";
            CLI::Option* option =
                addOption(app, names, typed.scene_flags[std::string(flag.name)], std::string(flag.doc), "Scene");
            if (flag.value_optional) option->expected(0, 1);
        }
    }
    if (command.uses_material || command.uses_scene)
        for (const MaterialFlag& flag : material_flags) {
            // A scene has one model, and --model says which.
            if (command.uses_scene && flag.name == std::string_view("inverted_by")) continue;
            addOption(app, flagOf(flag.name), typed.material[flag.name], flag.doc, "Material");
        }
    if (command.uses_material && !command.uses_scene)
        app.add_option("--scene", typed.scene, "a scene file, whose material is used")
            ->type_name("")
            ->group("Material");
    if (command.uses_seed) app.add_option("--seed", typed.seed, "of the random walks (default 1)")->type_name("");
    if (!command.output.empty())
        app.add_option("-o,--output", typed.output, std::string(command.output))->type_name("");
    app.add_flag("--json", arguments.json, "print one JSON document");
    app.add_flag("--print-job", arguments.print_job, "print the job file for `searchlight run` and stop");
    const bool lists_models = std::ranges::any_of(
        command.options, [](const Param& param) { return param.name == "model" || param.name == "models"; });
    if (lists_models || command.uses_scene)
        app.add_flag("--watch", arguments.watch, "run again whenever a model file changes, until Ctrl+C");
}

// The material flags of a command line, each read as the scene format reads its key.
class MaterialFlags {
public:
    explicit MaterialFlags(const Typed& typed) : typed_(typed.material) {}

    bool has(std::string_view name) const { return find(name) != nullptr; }
    const std::string& text(std::string_view name) const { return *find(name); }
    std::vector<double> list(std::string_view name) const { return std::get<std::vector<double>>(value(name, name)); }
    double number(std::string_view name, std::string_view key) const { return std::get<double>(value(name, key)); }

    /// Both of a pair, or a usage Error that names what is missing.
    void needBoth(std::string_view a, std::string_view b) const {
        if (!has(a)) throw usageError(fmt::format("{} needs {}", flagOf(b), flagOf(a)));
        if (!has(b)) throw usageError(fmt::format("{} needs {}", flagOf(a), flagOf(b)));
    }

private:
    const std::string* find(std::string_view name) const {
        const auto found = typed_.find(name);
        return found == typed_.end() || found->second.empty() ? nullptr : &found->second.back();
    }
    ParamValue value(std::string_view name, std::string_view key) const {
        const auto section = std::ranges::find(sceneSections(), "material", &SceneSection::name);
        return parseValue(findParam(section->keys, key, "option"), text(name));
    }

    const std::map<std::string, std::vector<std::string>, std::less<>>& typed_;
};

void applyMaterial(const MaterialFlags& flags, SceneMaterial& material) {
    const bool named = flags.has("material"), spelled = flags.has("sigma_s") || flags.has("sigma_a"),
               inverted = flags.has("Rdr") || flags.has("ld"), refined = flags.has("g") || flags.has("eta");
    if (named + spelled + inverted > 1)
        throw usageError("the material is given twice", "one of --material, --sigma-a with --sigma-s, --Rdr with --ld");
    if (named && refined)
        throw usageError("--g and --eta belong to --sigma-a and --sigma-s or to --Rdr and --ld",
                         "a named material has its own");
    if (refined && !spelled && !inverted)
        throw usageError("--g and --eta alone make no material", "add --sigma-a and --sigma-s, or --Rdr and --ld");

    if (named || spelled || inverted) material = {};
    if (spelled || inverted) material.id.clear();
    if (named) material.id = flags.text("material");
    if (spelled) {
        flags.needBoth("sigma_a", "sigma_s");
        material.sigma_a = flags.list("sigma_a");
        material.sigma_s = flags.list("sigma_s");
    }
    if (inverted) {
        flags.needBoth("Rdr", "ld");
        material.Rdr = flags.list("Rdr");
        material.ld = flags.list("ld");
    }
    if (flags.has("g")) material.g = flags.list("g");
    if (flags.has("eta")) material.eta = flags.number("eta", "eta");
    if (flags.has("material_scale")) material.scale = flags.number("material_scale", "scale");
}

// Where an object is expected a scene file may stand: it has one.
std::string sceneInPlaceOfObject(Typed& typed) {
    if (!typed.command->uses_scene) return {};
    std::vector<std::string>& objects = typed.scene_flags["object"];
    if (objects.empty() || !objects.back().ends_with(".json")) return {};
    std::string path = objects.back();
    if (!typed.scene.empty())
        throw usageError(fmt::format("two scenes are given: {} and {}", typed.scene, path), "one of them");
    objects.clear();
    return path;
}

// Rdr and ld are a statement about one model: the one that is named, or that the command is about, if it is about one.
void applyInvertingModel(const Typed& typed, Job& job) {
    const MaterialFlags flags(typed);
    if (!job.scene.material.inverted()) {
        if (flags.has("inverted_by")) throw usageError("--inverted-by belongs to --Rdr and --ld", "leave it out");
        return;
    }
    if (flags.has("inverted_by")) {
        const std::vector<std::string_view> parts = split(flags.text("inverted_by"), ':');
        job.scene.model.id = parts.front();
        job.scene.model.parameters = parseSettings(loadModel(parts.front()), {parts.begin() + 1, parts.end()});
    } else if (const auto model = job.options.find("model"); model != job.options.end()) {
        job.scene.model.id = std::get<std::string>(model->second);
    }
}

Job jobOf(Typed& typed) {
    Job job;
    job.command = typed.command->name;
    if (std::string path = sceneInPlaceOfObject(typed); !path.empty()) typed.scene = std::move(path);
    if (!typed.scene.empty()) job.scene = parseScene(readFile(typed.scene), typed.scene);
    if (typed.command->uses_material || typed.command->uses_scene)
        applyMaterial(MaterialFlags(typed), job.scene.material);
    if (typed.command->uses_scene) applySceneFlags(typed.scene_flags, job.scene);
    for (const Param& param : typed.command->options) {
        const std::vector<std::string>& values = typed.options.at(param.name);
        if (values.empty()) {
            if (param.required)
                throw usageError(fmt::format("{} is missing", flagOf(param.name)), std::string(typed.command->example));
            continue;
        }
        // A list in text, such as --set, may be given piece by piece.
        const bool joins = param.type == ParamType::text && !isPositional(*typed.command, param);
        const bool stands_alone = param.type == ParamType::toggle && values.back().empty();
        job.options[param.name] = stands_alone ? true : parseValue(param, joins ? join(values, ",") : values.back());
    }
    if (typed.command->uses_material || typed.command->uses_scene) applyInvertingModel(typed, job);
    if (!typed.seed.empty()) {
        const std::optional<double> seed = parseNumber(typed.seed);
        if (!seed || *seed < 0 || *seed != std::floor(*seed) || *seed > 9007199254740992.0)
            throw usageError(fmt::format("'{}' is no seed", typed.seed), "a whole number from 0 to 2^53");
        job.seed = static_cast<std::uint64_t>(*seed);
    }
    job.output = typed.output;
    return job;
}

// What CLI11 could not place: an option of no command, or a word too many.
Error strayError(const CLI::App& app, const std::string& stray, bool has_subcommands) {
    if (stray.starts_with("-")) {
        std::vector<std::string> names;
        for (const CLI::Option* option : app.get_options())
            for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
        return unknownName(ErrorKind::usage, "option", stray.substr(0, stray.find('=')), names);
    }
    if (has_subcommands) {
        std::vector<std::string> names;
        for (const CLI::App* sub : app.get_subcommands([](const CLI::App*) { return true; }))
            names.push_back(sub->get_name());
        return unknownName(ErrorKind::usage, "command", stray, names);
    }
    return usageError(fmt::format("'{}' is one word too many", stray), "see --help");
}

}  // namespace

Arguments parseArguments(int argc, char** argv) {
    CLI::App root("Searchlight: develops, displays, compares and validates models of subsurface scattering.",
                  "searchlight");
    root.set_version_flag("--version", fmt::format("searchlight {}", version()));
    root.set_help_flag("-h,--help", "Say how this is used");
    root.footer("searchlight COMMAND --help says more, with an example.");
    root.allow_extras();
    root.require_subcommand(0, 1);

    Arguments arguments;
    std::vector<Typed> all(commands().size());
    for (std::size_t i = 0; i < all.size(); ++i) {
        all[i].command = &commands()[i];
        declare(root, all[i], arguments);
    }
    std::string job_path, job_output;
    CLI::App* run_job = root.add_subcommand("run", "Run a job file");
    run_job->add_option("job", job_path, "a file that --print-job wrote")->required()->type_name("JOB.json");
    run_job->add_option("-o,--output", job_output, "in place of the job's own")->type_name("");
    run_job->add_flag("--json", arguments.json, "print one JSON document");
    run_job->footer("Example:\n  searchlight run job.json");
    run_job->allow_extras();

    try {
        root.parse(argc, argv);
    } catch (const CLI::CallForHelp&) {
        arguments.text = root.help();
        return arguments;
    } catch (const CLI::CallForVersion&) {
        arguments.text = fmt::format("searchlight {}\n", version());
        return arguments;
    } catch (const CLI::ArgumentMismatch& error) {
        const std::string_view what = error.what();
        throw usageError(fmt::format("{} needs a value", what.substr(0, what.find(':'))), "see --help");
    } catch (const CLI::ParseError& error) {
        throw usageError(error.what(), "see --help");
    }

    // The innermost subcommand that was named.
    CLI::App* app = &root;
    while (!app->get_subcommands().empty()) app = app->get_subcommands().front();
    const bool has_subcommands = !app->get_subcommands([](const CLI::App*) { return true; }).empty();
    for (const CLI::App* level = app; level; level = level->get_parent())
        if (!level->remaining().empty()) throw strayError(*app, level->remaining().front(), has_subcommands);

    if (app == run_job) {
        arguments.job = parseJob(readFile(job_path), job_path);
        if (!job_output.empty()) arguments.job->output = job_output;
        return arguments;
    }
    for (Typed& typed : all)
        if (typed.app == app) {
            arguments.job = jobOf(typed);
            return arguments;
        }
    if (app != &root) {
        std::vector<std::string> kinds;
        for (const CLI::App* kind : app->get_subcommands([](const CLI::App*) { return true; }))
            kinds.push_back(kind->get_name());
        throw usageError(fmt::format("{} of what?", app->get_name()), "valid: " + join(kinds, ", "));
    }
    arguments.text = root.help();
    return arguments;
}

}  // namespace searchlight
