#include "base/error.h"
#include "base/text.h"
#include "job/command_table.h"

namespace searchlight {

namespace {

constexpr double unlimited = 1e300;

// Options that several commands share.

Param model() {
    return {.name = "model",
            .type = ParamType::text,
            .value = std::string("dipole"),
            .doc = "a model's id, a .bssrdf file or a measured .csv profile"};
}
Param models() {
    return {.name = "models",
            .type = ParamType::text,
            .value = std::string("all"),
            .doc = "models separated by commas, each with settings if wanted: dipole,better_dipole:Moments=exact"};
}
Param set() {
    return {.name = "set",
            .type = ParamType::text,
            .value = std::string(),
            .doc = "model parameters: name=value, several separated by commas"};
}
Param backend() {
    return {.name = "backend",
            .type = ParamType::choice,
            .value = std::string("auto"),
            .choices = {"auto", "cpu", "gl"},
            .doc = "auto: native code for shipped models, OpenGL for others"};
}
Param angle() {
    return {.name = "angle_deg", .unit = "deg", .min = 0, .max = 89.9, .value = 0.0, .doc = "of incidence"};
}
Param threads() {
    return {.name = "threads", .type = ParamType::integer, .min = 0, .max = 4096, .value = 0.0, .doc = "0: all"};
}
Param walks(double value, std::string name = "walks", std::string doc = "random walks per channel", double min = 1) {
    return {.name = std::move(name),
            .type = ParamType::integer,
            .min = min,
            .max = 1e15,
            .value = value,
            .doc = std::move(doc)};
}
Param radiiMax() {
    return {.name = "radii_max",
            .unit = "mm",
            .min = 0,
            .max = unlimited,
            .value = 0.0,
            .doc = "largest radius; 0: chosen from the medium"};
}
Param bins(double value) {
    return {.name = "bins", .type = ParamType::integer, .min = 1, .max = 1e6, .value = value, .doc = "radial bins"};
}
Param channel() {
    return {.name = "channel",
            .type = ParamType::choice,
            .value = std::string("R"),
            .choices = {"R", "G", "B", "luminance"},
            .doc = "what is plotted"};
}
Param scale(std::string name, std::string value) {
    return {.name = std::move(name),
            .type = ParamType::choice,
            .value = std::move(value),
            .choices = {"lin", "log", "sqrt"},
            .doc = "scale of the axis"};
}
Param solo() {
    return {.name = "solo",
            .type = ParamType::text,
            .value = std::string(),
            .doc = "show this model alone, its channels apart"};
}

std::vector<Command> makeCommands() {
    const Param reference_walks = walks(0, "reference_walks", "random walks of the reference per channel; 0: none", 0);
    return {
        {.name = "models",
         .summary = "List the models, with their parameters",
         .example = "searchlight models",
         .run = runModels},
        {.name = "materials",
         .summary = "List the measured materials",
         .example = "searchlight materials",
         .run = runMaterials},
        {.name = "profile",
         .summary = "Evaluate R_d(r) of a model",
         .example = "searchlight profile --model dipole --material skin1 --radii 0.1,1,10",
         .options = {model(),
                     set(),
                     {.name = "radii",
                      .type = ParamType::numbers,
                      .unit = "mm",
                      .min = 0,
                      .max = unlimited,
                      .value = std::vector<double>{},
                      .doc = "where to evaluate; absent: an adaptive table"},
                     angle(),
                     {.name = "per",
                      .type = ParamType::choice,
                      .value = std::string("transmitted"),
                      .choices = {"transmitted", "incident"},
                      .doc = "per unit of which flux"},
                     backend()},
         .uses_material = true,
         .output = "profile: .json, or .csv that loads as a measured model",
         .run = runProfile},
        {.name = "invert",
         .summary = "Find sigma_a and sigma_s' from reflectance and mean free path",
         .example = "searchlight invert --model dipole --Rdr 0.44,0.22,0.13 --ld 3.673,1.367,0.683 --eta 1.3",
         .options =
             {model(),
              set(),
              {.name = "Rdr",
               .type = ParamType::channels,
               .min = 0,
               .max = 1,
               .doc = "total diffuse reflectance",
               .required = true,
               .exclusive = true},
              {.name = "ld",
               .type = ParamType::channels,
               .unit = "mm",
               .min = 0,
               .max = unlimited,
               .doc = "diffuse mean free path",
               .required = true,
               .exclusive = true},
              {.name = "eta", .min = .25, .max = 4, .value = 1.3, .doc = "refractive index, inside over outside"},
              {.name = "g", .min = -.99, .max = .99, .value = 0.0, .doc = "mean cosine, to unreduce sigma_s'"},
              backend()},
         .run = runInvert},
        {.name = "reference halfspace",
         .summary = "Walk the searchlight problem by unbiased Monte Carlo",
         .example = "searchlight reference halfspace --material skin1 --walks 1e6 --radii-max 10 --bins 100 --json",
         .options = {walks(1e6),
                     {.name = "edges",
                      .type = ParamType::numbers,
                      .unit = "mm",
                      .min = 0,
                      .max = unlimited,
                      .value = std::vector<double>{},
                      .doc = "edges of the radial bins"},
                     radiiMax(),
                     bins(100),
                     angle(),
                     {.name = "grid",
                      .type = ParamType::integer,
                      .min = 0,
                      .max = 4096,
                      .value = 0.0,
                      .doc = "cells per side of a tally R(x, y); 0: none"},
                     {.name = "grid_extent",
                      .unit = "mm",
                      .min = 0,
                      .max = unlimited,
                      .value = 0.0,
                      .doc = "half the side of that square"},
                     {.name = "estimator",
                      .type = ParamType::choice,
                      .value = std::string("analogue"),
                      .choices = {"analogue", "best"},
                      .doc = "best: profiles with far less noise, except for g > 0.7 and for --grid; a noisier total"},
                     {.name = "white",
                      .type = ParamType::toggle,
                      .value = false,
                      .doc = "from a table of walks without absorption, kept on disk: a new sigma_a or sigma_s, up to "
                             "albedo 0.9999, walks nothing"},
                     {.name = "exact",
                      .type = ParamType::toggle,
                      .value = false,
                      .doc =
                          "solve without walks: eta 1, g 0, normal incidence; stderr then bounds the numerical error"},
                     threads()},
         .uses_material = true,
         .uses_seed = true,
         .output = "the JSON document",
         .run = runReferenceHalfSpace},
        {.name = "reference slab",
         .summary = "Walk a pencil beam on plane layers by unbiased Monte Carlo",
         .example = "searchlight reference slab --layers layers.json --walks 1e6 --json",
         .options = {{.name = "layers",
                      .type = ParamType::path,
                      .value = std::string(),
                      .doc = "the slab: a searchlight-layers/1 file"},
                     {.name = "mci",
                      .type = ParamType::path,
                      .value = std::string(),
                      .doc = "or an input file of MCML, with its grid and number of photons"},
                     {.name = "run",
                      .type = ParamType::integer,
                      .min = 1,
                      .max = 32767,
                      .value = 1.0,
                      .doc = "which run of that file"},
                     walks(1e6, "walks", "random walks"),
                     angle(),
                     {.name = "edges",
                      .type = ParamType::numbers,
                      .unit = "mm",
                      .min = 0,
                      .max = unlimited,
                      .value = std::vector<double>{},
                      .doc = "edges of the radial bins"},
                     radiiMax(),
                     bins(100),
                     {.name = "angles",
                      .type = ParamType::integer,
                      .min = 1,
                      .max = 1e4,
                      .value = 30.0,
                      .doc = "equal parts of 90 deg, for what leaves"},
                     {.name = "depths",
                      .type = ParamType::integer,
                      .min = 1,
                      .max = 1e6,
                      .value = 100.0,
                      .doc = "equal parts of the depth, for what is absorbed"},
                     {.name = "depth",
                      .unit = "mm",
                      .min = 0,
                      .max = unlimited,
                      .value = 0.0,
                      .doc = "largest depth; 0: chosen from the slab"},
                     {.name = "maps",
                      .type = ParamType::toggle,
                      .value = false,
                      .doc = "also A(r, z), fluence(r, z), R(r, alpha), T(r, alpha)"},
                     threads()},
         .uses_seed = true,
         .output = "the JSON document",
         .run = runReferenceSlab},
        {.name = "mcml",
         .summary = "Walk the runs of an MCML input file and write its output files",
         .example = "searchlight mcml sample.mci",
         .options = {{.name = "input", .type = ParamType::path, .doc = "an .mci file, version 1.0", .required = true},
                     walks(1e6, "walks", "random walks of every run; absent: the photons of the file"),
                     threads()},
         .positional = "input",
         .uses_seed = true,
         .output = "a JSON document with every standard error, beside the .mco files",
         .run = runMcml},
        {.name = "plot pencil",
         .summary = "Plot the searchlight profiles of models, beside the reference",
         .example = "searchlight plot pencil --material skin1 --models dipole,better_dipole --reference-walks 1e6 -o "
                    "pencil.svg",
         .options = {models(),
                     reference_walks,
                     channel(),
                     scale("x_scale", "lin"),
                     scale("y_scale", "log"),
                     {.name = "times_radius",
                      .type = ParamType::integer,
                      .min = 0,
                      .max = 2,
                      .value = 0.0,
                      .doc = "plot R_d r^n"},
                     solo(),
                     angle(),
                     radiiMax(),
                     bins(64),
                     backend(),
                     threads()},
         .uses_material = true,
         .uses_seed = true,
         .output = "figure: .svg, .png, .pdf or .csv",
         .run = runPlotPencil},
        {.name = "plot error",
         .summary = "Plot the relative error of models against the reference",
         .example = "searchlight plot error --material skin1 --models all --reference-walks 1e6 -o error.svg",
         .options = {models(), walks(1e6, "reference_walks", "random walks of the reference per channel"), channel(),
                     scale("x_scale", "sqrt"), solo(), angle(), radiiMax(), bins(64), backend(), threads()},
         .uses_material = true,
         .uses_seed = true,
         .output = "figure: .svg, .png, .pdf or .csv",
         .run = runPlotError},
        {.name = "plot albedo",
         .summary = "Plot total diffuse reflectance against albedo",
         .example = "searchlight plot albedo --eta 1.3 --reference-walks 1e5 -o albedo.svg",
         .options =
             {models(),
              {.name = "eta", .min = .25, .max = 4, .value = 1.3, .doc = "refractive index, inside over outside"},
              {.name = "g", .min = -.99, .max = .99, .value = 0.0, .doc = "mean cosine of the phase function"},
              walks(0, "reference_walks", "random walks per point of the reference; 0: none", 0),
              backend()},
         .uses_seed = true,
         .output = "figure: .svg, .png, .pdf or .csv",
         .run = runPlotAlbedo},
        {.name = "check",
         .summary = "Check a model file: does it compile, is it physical, is it portable",
         .example = "searchlight check models/dipole.bssrdf",
         .options =
             {{.name = "model", .type = ParamType::text, .doc = "a .bssrdf file or a model's id", .required = true},
              set()},
         .positional = "model",
         .run = runCheck},
        {.name = "report",
         .summary = "Write a page: every model beside the reference, on a material",
         .example = "searchlight report --material marble -o out/",
         .options = {models(), walks(4e6),
                     walks(2e5, "albedo_walks", "random walks per point of the albedo figure; 0: none", 0), angle(),
                     radiiMax(), bins(64), backend(), threads()},
         .uses_material = true,
         .uses_seed = true,
         .output = "folder of the page, its figures and its numbers",
         .run = runReport},
        {.name = "doctor",
         .summary = "Say what this machine has and what is missing",
         .example = "searchlight doctor",
         .run = runDoctor},
    };
}

}  // namespace

std::span<const Command> commands() {
    static const std::vector<Command> table = makeCommands();
    return table;
}

const Command& findCommand(std::string_view name) {
    std::vector<std::string> names;
    for (const Command& command : commands()) {
        if (command.name == name) return command;
        names.emplace_back(command.name);
    }
    throw unknownName(ErrorKind::usage, "command", name, names);
}

std::vector<std::string> Options::names(std::string_view name) const {
    std::vector<std::string> parts;
    if (text(name).empty()) return parts;
    for (const std::string_view part : split(text(name), ',')) parts.emplace_back(trim(part));
    return parts;
}

const ParamValue& Options::value(std::string_view name) const {
    return valueOf(findParam(command_.options, name, "option"), job_.options);
}

}  // namespace searchlight
