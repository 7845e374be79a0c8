// The table of commands. A command is one file command_x.cpp, which says what it is called and takes, and one
// line in commands.cpp. Command line, job files and the reference page come from its Params.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "job/engine.h"
#include "job/job.h"

namespace searchlight {

struct Command {
    std::string_view name;     ///< "plot pencil": words are subcommands
    std::string_view summary;  ///< one line
    std::string_view example;  ///< a whole command line that works
    std::vector<Param> options;
    /// The options that may be given without their names, in that order: "image reference".
    std::string_view positional;
    bool uses_material = false;  ///< takes --material, --sigma-a ... (scene.material)
    bool uses_scene = false;  ///< takes an object, --light, --camera ... and what uses_material does: all of the scene
    bool uses_seed = false;   ///< takes --seed
    bool shares_walks = false;     ///< mpirun shares its work among processes
    bool writes_in_parts = false;  ///< and each of them writes its part of the files
    bool writes_folder = false;    ///< -o names a folder, which the command makes
    std::string_view output;       ///< what -o writes ("figure: .svg, .png, .pdf or .csv"); empty: no -o
    JobResult (*run)(const Job& job, Engine& engine, Observer& observer);
};

/// In menu order.
std::span<const Command> commands();

/// Throws unknownName.
const Command& findCommand(std::string_view name);

/// Typed access to a job's options, with the command's defaults.
class Options {
public:
    Options(const Job& job, const Command& command) : job_(job), command_(command) {}
    explicit Options(const Job& job) : Options(job, findCommand(job.command)) {}

    bool given(std::string_view name) const { return job_.options.contains(name); }
    double number(std::string_view name) const { return std::get<double>(value(name)); }
    bool toggle(std::string_view name) const { return std::get<bool>(value(name)); }
    const std::string& text(std::string_view name) const { return std::get<std::string>(value(name)); }
    const std::vector<double>& list(std::string_view name) const { return std::get<std::vector<double>>(value(name)); }
    /// A comma-separated text option as its parts; empty text: no parts.
    std::vector<std::string> names(std::string_view name) const;

private:
    const ParamValue& value(std::string_view name) const;

    const Job& job_;
    const Command& command_;
};

}  // namespace searchlight
