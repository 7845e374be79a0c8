// A text file as lines: byte order mark, line ends, and what is no text.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "language/parameter_lines.h"

namespace searchlight {

/// `text` without byte order mark and with '\n' line ends. Throws an input Error (line, column; no file) when it is
/// larger than `max_bytes`, holds a NUL byte, or is no UTF-8.
std::string normalizeText(std::string_view text, std::size_t max_bytes);

/// The lines of `text`, trimmed; each text is never null and points into `text`.
std::vector<SourceLine> splitLines(std::string_view text);

}  // namespace searchlight
