#include "language/glsl_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>

namespace searchlight {

namespace {

using Names = std::set<std::string, std::less<>>;

Names valueTypes() {
    Names names = {"float", "int", "uint", "bool"};
    for (const char size : {'2', '3', '4'}) {
        for (const char* prefix : {"vec", "ivec", "uvec", "bvec", "mat"})
            names.insert(fmt::format("{}{}", prefix, size));
        for (const char rows : {'2', '3', '4'}) names.insert(fmt::format("mat{}x{}", size, rows));
    }
    return names;
}

// [GLSL450] section 3.6, less the value types.
Names keywords() {
    Names names = {
        "attribute",     "const",    "uniform",   "varying",     "buffer",    "shared",       "coherent", "volatile",
        "restrict",      "readonly", "writeonly", "atomic_uint", "layout",    "centroid",     "flat",     "smooth",
        "noperspective", "patch",    "sample",    "break",       "continue",  "do",           "for",      "while",
        "switch",        "case",     "default",   "if",          "else",      "subroutine",   "in",       "out",
        "inout",         "void",     "true",      "false",       "invariant", "precise",      "discard",  "return",
        "double",        "lowp",     "mediump",   "highp",       "precision", "struct",       "common",   "partition",
        "active",        "asm",      "class",     "union",       "enum",      "typedef",      "template", "this",
        "resource",      "goto",     "inline",    "noinline",    "public",    "static",       "extern",   "external",
        "interface",     "long",     "short",     "half",        "fixed",     "unsigned",     "superp",   "input",
        "output",        "hvec2",    "hvec3",     "hvec4",       "fvec2",     "fvec3",        "fvec4",    "filter",
        "sizeof",        "cast",     "namespace", "using",       "row_major", "sampler3DRect"};
    for (const char size : {'2', '3', '4'}) {
        names.insert(fmt::format("dvec{}", size));
        names.insert(fmt::format("dmat{}", size));
        for (const char rows : {'2', '3', '4'}) names.insert(fmt::format("dmat{}x{}", size, rows));
    }
    for (const char* kind : {"sampler", "isampler", "usampler", "image", "iimage", "uimage"})
        for (const char* shape :
             {"1D", "2D", "3D", "Cube", "2DRect", "1DArray", "2DArray", "Buffer", "2DMS", "2DMSArray", "CubeArray"})
            names.insert(fmt::format("{}{}", kind, shape));
    for (const char* shape : {"1D", "2D", "Cube", "2DRect", "1DArray", "2DArray", "CubeArray"})
        names.insert(fmt::format("sampler{}Shadow", shape));
    return names;
}

}  // namespace

bool isGlslValueType(std::string_view name) {
    static const Names names = valueTypes();
    return names.contains(name);
}

bool isGlslKeyword(std::string_view name) {
    static const Names names = keywords();
    return names.contains(name) || isGlslValueType(name);
}

bool isModelGlobal(std::string_view name) {
    constexpr std::array<std::string_view, 7> names = {"SigmaA", "SigmaS", "G", "IOR", "PI", "Ni", "No"};
    return std::ranges::find(names, name) != names.end();
}

const std::vector<std::string>& portableBuiltins() {
    static const std::vector<std::string> names = {
        "abs",         "acos",  "all",        "any",     "asin",     "atan",          "ceil",
        "clamp",       "cos",   "cosh",       "cross",   "degrees",  "distance",      "dot",
        "equal",       "exp",   "exp2",       "floor",   "fract",    "greaterThan",   "greaterThanEqual",
        "inversesqrt", "isinf", "isnan",      "length",  "lessThan", "lessThanEqual", "log",
        "log2",        "max",   "min",        "mix",     "mod",      "normalize",     "not",
        "notEqual",    "pow",   "radians",    "reflect", "refract",  "round",         "sign",
        "sin",         "sinh",  "smoothstep", "sqrt",    "step",     "tan",           "tanh",
        "transpose",   "trunc"};
    return names;
}

std::string whyReserved(std::string_view name) {
    if (isGlslKeyword(name)) return "a word of GLSL";
    if (std::ranges::binary_search(portableBuiltins(), name)) return "a function of GLSL";
    if (isModelGlobal(name)) return "given to every model";
    constexpr std::array<std::string_view, 3> entry_points = {"init", "Bssrdf", "DiffuseReflectance"};
    if (std::ranges::find(entry_points, name) != entry_points.end()) return "the name of an entry point";
    constexpr std::array<std::string_view, 4> arguments = {"Xi", "Wi", "Xo", "Wo"};
    if (std::ranges::find(arguments, name) != arguments.end()) return "an argument of Bssrdf";
    if (name.starts_with("gl_")) return "GLSL keeps names that start with gl_";
    if (name.starts_with("sl_")) return "names that start with sl_ are taken";
    if (name == "main") return "the name of the program's entry point";
    if (name.find("__") != std::string_view::npos) return "GLSL keeps names with two underscores";
    return {};
}

}  // namespace searchlight
