// Shader text that remembers where each line came from.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace searchlight::gl {

struct SourcePlace {
    std::string file;
    int line = 0, column = 0;  ///< 1-based; 0: unknown
};

/// Shader text put together from files. It carries no #line: Mesa loses the source-string number of most expressions
/// and counts columns after its preprocessor has squeezed white space, so that places are looked up here instead.
class Source {
public:
    /// Appends whole lines, the first of which is `first_line` of `file`. Closes the last line.
    void add(std::string_view text, std::string_view file, int first_line = 1);

    /// Appends one token as a line of its own. An error on that line is then known to the column, whatever the driver
    /// says about columns and whatever else is inserted around the token.
    void addToken(std::string_view token, std::string_view file, int line, int column);

    const std::string& text() const { return text_; }

    /// Where the driver's line and column (0: unknown) of text() came from. A line outside text() has no place.
    SourcePlace place(int line, int column) const;

private:
    struct Line {
        int file;
        int line;
        int column;  // of the token; 0: a whole line
        std::size_t begin;
    };
    int fileIndex(std::string_view file);

    std::string text_;
    std::vector<std::string> files_;
    std::vector<Line> lines_;
};

}  // namespace searchlight::gl
