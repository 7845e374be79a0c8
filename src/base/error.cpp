#include "base/error.h"

#include <fmt/format.h>

#include "base/text.h"

namespace searchlight {

Error::Error(ErrorKind kind_, std::string message_, std::string hint_)
    : kind(kind_), message(std::move(message_)), hint(std::move(hint_)) {
    compose();
}

Error Error::at(std::string_view file_, int line_, int column_) const {
    Error placed = *this;
    if (placed.file.empty()) placed.file = file_;
    if (placed.line == 0) {
        placed.line = line_;
        placed.column = column_;
    }
    placed.compose();
    return placed;
}

void Error::compose() {
    text_.clear();
    if (!file.empty()) text_ += file + ":";
    if (line > 0) text_ += fmt::format("{}:", line);
    if (line > 0 && column > 0) text_ += fmt::format("{}:", column);
    if (!text_.empty()) text_ += ' ';
    text_ += message;
    if (!hint.empty()) text_ += " (" + hint + ")";
}

Error usageError(std::string message, std::string hint) {
    return {ErrorKind::usage, std::move(message), std::move(hint)};
}
Error inputError(std::string message, std::string hint) {
    return {ErrorKind::input, std::move(message), std::move(hint)};
}
Error deviceError(std::string message, std::string hint) {
    return {ErrorKind::device, std::move(message), std::move(hint)};
}
Error interruptedError() { return {ErrorKind::interrupted, "interrupted"}; }

Error unknownName(ErrorKind kind, std::string_view what, std::string_view name, const std::vector<std::string>& valid) {
    // Up to a dozen names are listed whole; of more, the three nearest.
    const bool few = valid.size() <= 12;
    const std::vector<std::string> shown = few ? valid : nearestNames(name, valid, 3);
    return {kind, fmt::format("unknown {} '{}'", what, name),
            fmt::format("{}: {}", few ? "valid" : "did you mean", join(shown, ", "))};
}

}  // namespace searchlight
