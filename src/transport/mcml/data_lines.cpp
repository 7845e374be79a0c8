#include "transport/mcml/data_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "base/text.h"

namespace searchlight {

DataLines::DataLines(std::string_view text, std::string_view path) : path_(path) {
    int number = 0;
    for (std::string_view line : split(text, '\n')) {
        ++number;
        line = line.substr(0, line.find('#'));
        std::vector<Word> words;
        for (std::size_t at = 0; (at = line.find_first_not_of(" \t\r\f\v", at)) != std::string_view::npos;) {
            const std::size_t end = std::min(line.find_first_of(" \t\r\f\v", at), line.size());
            words.push_back({line.substr(at, end - at), number, static_cast<int>(at) + 1});
            at = end;
        }
        if (!words.empty()) lines_.push_back(std::move(words));
    }
    last_line_ = number;
}

Error DataLines::error(const Word& word, std::string message, std::string hint) const {
    return inputError(std::move(message), std::move(hint)).at(path_, word.line, word.column);
}

const std::vector<Word>& DataLines::take(std::size_t count, std::string_view what) {
    const std::vector<Word>& line = take(what);
    if (line.size() < count) throw error(line.back(), fmt::format("{} of {} values of {}", line.size(), count, what));
    if (line.size() > count)
        throw error(line[count], fmt::format("'{}' after {}", line[count].text, what), "# starts a comment");
    return line;
}

const std::vector<Word>& DataLines::take(std::string_view what) {
    if (done()) throw inputError(fmt::format("the file ends before {}", what)).at(path_, std::max(last_line_, 1), 1);
    return lines_[next_++];
}

double DataLines::number(const Word& word, std::string_view what) const {
    const std::optional<double> value = parseNumber(word.text);
    if (!value) throw error(word, fmt::format("'{}' is no number", word.text), fmt::format("expected {}", what));
    return *value;
}

double DataLines::number(const Word& word, std::string_view what, double min, double max) const {
    const double value = number(word, what);
    if (value < min || value > max)
        throw error(word, fmt::format("{} is {}", what, word.text),
                    max >= 1e15 ? fmt::format("at least {}", numberText(min))
                                : fmt::format("{} to {}", numberText(min), numberText(max)));
    return value;
}

double DataLines::positive(const Word& word, std::string_view what) const {
    const double value = number(word, what);
    if (!(value > 0)) throw error(word, fmt::format("{} is {}", what, word.text), "above 0");
    return value;
}

double DataLines::whole(const Word& word, std::string_view what, double max) const {
    const double value = number(word, what, 1, max);
    if (value != std::floor(value)) throw error(word, fmt::format("{} is {}", what, word.text), "a whole number");
    return value;
}

}  // namespace searchlight
