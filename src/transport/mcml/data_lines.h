// The lines of MCML's files, which hold words.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"

namespace searchlight {

/// Stands at a line and a column, both from 1.
struct Word {
    std::string_view text;
    int line = 0, column = 0;
};

/// The lines that hold any words; # starts a comment. Errors have file, line and column; `what` names in them what was
/// expected. The text outlives this.
class DataLines {
public:
    DataLines(std::string_view text, std::string_view path);

    Error error(const Word& word, std::string message, std::string hint = {}) const;

    /// The next line, which holds exactly so many words. Throws otherwise.
    const std::vector<Word>& take(std::size_t count, std::string_view what);
    /// The next line. Throws at the end of the file.
    const std::vector<Word>& take(std::string_view what);

    bool done() const { return next_ == lines_.size(); }
    /// The line that take() would return; not when done().
    const std::vector<Word>& peek() const { return lines_[next_]; }

    double number(const Word& word, std::string_view what) const;
    /// Within [min, max]; NaN has no text.
    double number(const Word& word, std::string_view what, double min, double max) const;
    double positive(const Word& word, std::string_view what) const;
    /// A whole number from 1 to max.
    double whole(const Word& word, std::string_view what, double max) const;

private:
    std::string path_;
    std::vector<std::vector<Word>> lines_;
    std::size_t next_ = 0;
    int last_line_ = 0;
};

}  // namespace searchlight
