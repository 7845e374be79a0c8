#include "job/shared_options.h"

#include "base/error.h"

namespace searchlight::option {

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
Param walkBackend() {
    return {.name = "backend",
            .type = ParamType::choice,
            .value = std::string("cpu"),
            .choices = {"cpu", "gl"},
            .doc = "what walks; gl: the analogue walk on OpenGL"};
}
Param angle() {
    return {.name = "angle_deg", .unit = "deg", .min = 0, .max = 89.9, .value = 0.0, .doc = "of incidence"};
}
Param angles(std::vector<double> value) {
    return {.name = "angle_deg",
            .type = ParamType::numbers,
            .unit = "deg",
            .min = 0,
            .max = 89.9,
            .value = std::move(value),
            .doc = "of incidence; several separated by commas"};
}
Param threads() {
    return {.name = "threads", .type = ParamType::integer, .min = 0, .max = 4096, .value = 0.0, .doc = "0: all"};
}
Param walks(double value, std::string name, std::string doc, double min) {
    return {.name = std::move(name),
            .type = ParamType::integer,
            .min = min,
            .max = 1e15,
            .value = value,
            .doc = std::move(doc)};
}
Param untilError(std::string_view of_what) {
    return {.name = "until_error",
            .type = ParamType::text,
            .value = std::string(),
            .doc = "stop, before all walks, when " + std::string(of_what) +
                   " have this relative standard error, such as 0.5%"};
}
Param resume() {
    return {.name = "resume",
            .type = ParamType::path,
            .value = std::string(),
            .doc = "go on from the walks in this file, if it exists, and keep them there, also after Ctrl+C"};
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

Param edges() {
    return {.name = "edges",
            .type = ParamType::numbers,
            .unit = "mm",
            .min = 0,
            .max = unlimited,
            .value = std::vector<double>{},
            .doc = "edges of the radial bins"};
}

bool edgesGiven(const Options& options) {
    if (!options.given("edges")) return false;
    if (options.given("bins") || options.given("radii_max"))
        throw usageError("--edges and --bins with --radii-max exclude each other", "give one of the two");
    return true;
}
Param grid(std::string_view of_what) {
    return {.name = "grid",
            .type = ParamType::integer,
            .min = 0,
            .max = 4096,
            .value = 0.0,
            .doc = "cells per side of a tally " + std::string(of_what) + "; 0: none"};
}
Param gridExtent() {
    return {.name = "grid_extent",
            .unit = "mm",
            .min = 0,
            .max = unlimited,
            .value = 0.0,
            .doc = "half the side of that square"};
}
void requireGridExtent(const Options& options) {
    if (options.number("grid") > 0 && !(options.number("grid_extent") > 0))
        throw usageError("--grid needs --grid-extent", "half the side of the square, in mm");
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

}  // namespace searchlight::option
