#include "io/words.h"

#include <fmt/format.h>

#include <algorithm>

namespace searchlight {

namespace {

bool isBlank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }

}  // namespace

std::string quotedWord(std::string_view word) {
    std::string shown;
    for (const char c : word.substr(0, 24)) shown += c >= ' ' && c <= '~' ? c : '?';
    return fmt::format("'{}{}'", shown, word.size() > 24 ? "..." : "");
}

void Words::skipBlanks(bool across_lines) {
    while (at_ < text_.size()) {
        const char c = text_[at_];
        if (comment_ != 0 && c == comment_)
            at_ = std::min(text_.find('\n', at_), text_.size());
        else if (isBlank(c) || (c == '\n' && across_lines))
            ++at_;
        else
            return;
    }
}

std::string_view Words::take() {
    word_at_ = at_;
    if (at_ == text_.size() || text_[at_] == '\n') return {};
    if (single_.find(text_[at_]) != std::string_view::npos) return text_.substr(at_++, 1);
    while (at_ < text_.size()) {
        const char c = text_[at_];
        if (isBlank(c) || c == '\n' || (comment_ != 0 && c == comment_) || single_.find(c) != std::string_view::npos)
            break;
        ++at_;
    }
    return text_.substr(word_at_, at_ - word_at_);
}

std::string_view Words::word(std::string_view what) {
    skipBlanks(true);
    const std::string_view found = take();
    if (found.empty()) throw error(fmt::format("the file ends before {}", what));
    return found;
}

std::string_view Words::wordInLine() {
    skipBlanks(false);
    return take();
}

std::string_view Words::peek() {
    skipBlanks(true);
    const std::string_view found = take();
    at_ = word_at_;
    return found;
}

std::string_view Words::restOfLine() {
    word_at_ = at_;
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    const std::string_view rest = text_.substr(at_, end - at_);
    at_ = std::min(end + 1, text_.size());
    return rest;
}

void Words::expect(std::string_view expected) {
    const std::string_view found = word(fmt::format("'{}'", expected));
    if (found != expected) throw error(quotedWord(found), fmt::format("expected '{}'", expected));
}

double Words::number(std::string_view what) {
    const std::string_view found = word(what);
    double value = 0;
    if (readReal(found.data(), found.data() + found.size(), value) != found.data() + found.size())
        throw error(fmt::format("{} is no number", quotedWord(found)), fmt::format("expected {}", what));
    return value;
}

std::size_t Words::count(std::string_view what) {
    const std::string_view found = word(what);
    std::size_t value = 0;
    const auto [last, status] = std::from_chars(found.data(), found.data() + found.size(), value);
    if (status != std::errc{} || last != found.data() + found.size())
        throw error(fmt::format("{} is no whole number of 0 or more", quotedWord(found)),
                    fmt::format("expected {}", what));
    return value;
}

Error Words::error(std::string message, std::string hint) const {
    return errorAt(word_at_, std::move(message), std::move(hint));
}

Error Words::errorAt(std::size_t byte, std::string message, std::string hint) const {
    const auto lines = std::count(text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(byte), '\n');
    return inputError(std::move(message), std::move(hint)).at(path_, static_cast<int>(lines) + 1);
}

}  // namespace searchlight
