#include "gl/source.h"

#include <algorithm>
#include <cassert>

#include "base/text.h"

namespace searchlight::gl {

namespace {

bool isSpace(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }

// Mesa's preprocessor leaves one space for each run of white space and comments: column 5 of "a  /* x */ b" is
// reported as 3. A comment that began on an earlier line is not seen here.
int columnBeforeSqueeze(std::string_view line, int squeezed) {
    std::size_t at = 0;
    for (int column = 1; at < line.size(); ++column) {
        if (column == squeezed) return static_cast<int>(at) + 1;
        const std::size_t run = at;
        while (at < line.size() && (isSpace(line[at]) || line.substr(at, 2) == "/*")) {
            const std::size_t end = isSpace(line[at]) ? at : line.find("*/", at + 2);
            if (end == line.npos) return squeezed;
            at = end + (isSpace(line[at]) ? 1 : 2);
        }
        if (at == run) ++at;
    }
    return squeezed;
}

}  // namespace

int Source::fileIndex(std::string_view file) {
    const auto known = std::find(files_.begin(), files_.end(), file);
    const auto index = static_cast<int>(known - files_.begin());
    if (known == files_.end()) files_.emplace_back(file);
    return index;
}

void Source::add(std::string_view text, std::string_view file, int first_line) {
    if (text.empty()) return;
    if (text.ends_with('\n')) text.remove_suffix(1);
    const int index = fileIndex(file);
    for (const std::string_view line : split(text, '\n')) {
        lines_.push_back({index, first_line++, 0, text_.size()});
        text_ += line;
        text_ += '\n';
    }
}

void Source::addToken(std::string_view token, std::string_view file, int line, int column) {
    assert(token.find('\n') == token.npos);
    lines_.push_back({fileIndex(file), line, column, text_.size()});
    text_ += token;
    text_ += '\n';
}

SourcePlace Source::place(int line, int column) const {
    if (line < 1 || line > static_cast<int>(lines_.size())) return {};
    const Line& origin = lines_[line - 1];
    if (origin.column == 0 && column > 0) {
        const std::string_view rest = std::string_view(text_).substr(origin.begin);
        column = columnBeforeSqueeze(rest.substr(0, rest.find('\n')), column);
    }
    return {files_[origin.file], origin.line, origin.column > 0 ? origin.column : column};
}

}  // namespace searchlight::gl
