// The lines of section parameters: "float Multiplier 0.0 10.0 1.0 [unit]  # doc".
#pragma once

#include <string_view>
#include <vector>

#include "base/param.h"

namespace searchlight {

/// One line of the file, white space at its ends removed.
struct SourceLine {
    std::string_view text;
    int line = 0;    ///< 1-based
    int column = 0;  ///< 1-based, of the first character of text
};

/// A word of a line, with its place.
using Word = SourceLine;

/// Words between blanks.
std::vector<Word> words(const SourceLine& line);

/// One parameter per line; blank lines and lines that start with '#' are none. Throws an input Error with line and
/// column, without file.
std::vector<Param> parseParameters(const std::vector<SourceLine>& lines);

}  // namespace searchlight
