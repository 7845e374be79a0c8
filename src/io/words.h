// Text files, read word by word. Lines are only counted when an error has to name one.
#pragma once

#include <charconv>
#include <cstddef>
#include <limits>
#include <string>
#include <string_view>

#include "base/error.h"

namespace searchlight {

/// Reads a number ("1", "+.5", "-1e-3", also "nan" and "inf") at `from`; returns its end, or `from` when there is none.
/// What is too small for the type becomes 0, what is too large infinity.
template <class Real>
const char* readReal(const char* from, const char* end, Real& value) {
    const char* first = from != end && *from == '+' ? from + 1 : from;
    const auto [last, status] = std::from_chars(first, end, value);
    if (status == std::errc::invalid_argument) return from;
    if (status == std::errc::result_out_of_range) {
        const std::string_view text(first, static_cast<std::size_t>(last - first));
        const std::size_t exponent = text.find_first_of("eE");
        const std::size_t digit = text.find_first_not_of('-');
        const bool small = exponent != std::string_view::npos ? text.substr(exponent + 1).starts_with('-')
                                                              : text[digit] == '0' || text[digit] == '.';
        value = small ? Real{0} : std::numeric_limits<Real>::infinity();
    }
    return last;
}

/// The beginning of a word from a file in quotes, for a message: garbage may be long, and no text.
std::string quotedWord(std::string_view word);

/// A walk through text in memory, which must outlive it. Words end at blanks; the characters of `single` are words of
/// their own; `comment` (when not 0) starts a comment that ends with the line.
class Words {
public:
    Words(std::string_view text, std::string_view path, char comment, std::string_view single = {})
        : text_(text), path_(path), comment_(comment), single_(single) {}

    /// The next word, on this line or a later one; an input Error that names `what` at the end of the file.
    std::string_view word(std::string_view what);

    /// The next word of this line; empty at its end.
    std::string_view wordInLine();

    /// The next word stays next; empty at the end of the file.
    std::string_view peek();

    /// What is left of this line, without its end; the next line is next.
    std::string_view restOfLine();

    /// Throws an input Error unless the next word is `expected`.
    void expect(std::string_view expected);

    /// A number, which may be infinite or NaN, and a whole number of 0 or more; input Errors name `what`.
    double number(std::string_view what);
    std::size_t count(std::string_view what);

    /// Steps over so many bytes; there must be as many.
    void skip(std::size_t bytes) { word_at_ = at_ += bytes; }

    std::size_t bytesLeft() const { return text_.size() - at_; }

    /// An input Error at the line of the word that was read last.
    Error error(std::string message, std::string hint = {}) const;
    Error errorAt(std::size_t byte, std::string message, std::string hint = {}) const;

private:
    void skipBlanks(bool across_lines);
    std::string_view take();

    std::string_view text_, path_;
    char comment_;
    std::string_view single_;
    std::size_t at_ = 0, word_at_ = 0;
};

}  // namespace searchlight
