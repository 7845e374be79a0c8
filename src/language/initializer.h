// The initializer section taken apart: its globals (the State), init(), and the rest.
#pragma once

#include <string>
#include <vector>

#include "language/bssrdf_file.h"

namespace searchlight {

/// One global of the initializer section. On GL it stands in a buffer block, in C++ it is a member.
struct StateVariable {
    std::string type;  ///< a GLSL type that a buffer block may hold: "float", "vec3", "int", "mat3", ...
    std::string name;
    int array_size = 0;         ///< 0: no array
    std::string initial_value;  ///< the expression after '=', empty without; to be assigned before init() runs
    int line = 0;               ///< 1-based, in the file, of the name
    int column = 0;
};

/// The two texts have the line structure of the section: what was taken out is blank, so that line n of either is line
/// first_line + n - 1 of the file.
struct Initializer {
    std::vector<StateVariable> state;
    std::string functions_text;  ///< const globals, structs and functions other than init()
    std::string init_text;       ///< void init() { ... } alone; empty when the file has no initializer section
    int first_line = 0;
};

/// Splits the initializer section. Throws an input Error with file, line and column: a global that no State can hold,
/// or a function other than init(), in any section, that writes State.
Initializer splitInitializer(const BssrdfFile& file);

}  // namespace searchlight
