#include "language/text_lines.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"

namespace searchlight {

namespace {

// Bytes of the UTF-8 sequence that starts `text`; 0 when it is none.
std::size_t sequenceSize(std::string_view text) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const unsigned char lead = byte(0);
    if (lead < 0x80) return 1;
    const std::size_t size = lead >= 0xc2 && lead < 0xe0   ? 2
                             : lead >= 0xe0 && lead < 0xf0 ? 3
                             : lead >= 0xf0 && lead < 0xf5 ? 4
                                                           : 0;
    if (size == 0 || size > text.size()) return 0;
    for (std::size_t i = 1; i < size; ++i)
        if ((byte(i) & 0xc0) != 0x80) return 0;
    // Overlong forms, surrogates, and beyond U+10FFFF.
    if ((lead == 0xe0 && byte(1) < 0xa0) || (lead == 0xed && byte(1) > 0x9f)) return 0;
    if ((lead == 0xf0 && byte(1) < 0x90) || (lead == 0xf4 && byte(1) > 0x8f)) return 0;
    return size;
}

}  // namespace

std::string normalizeText(std::string_view text, std::size_t max_bytes) {
    if (text.size() > max_bytes)
        throw inputError(fmt::format("the file has {} bytes", text.size()),
                         fmt::format("a model has at most {}", max_bytes));
    if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
    std::string clean;
    clean.reserve(text.size());
    int line = 1;
    std::size_t line_start = 0;
    for (std::size_t at = 0; at < text.size();) {
        const auto place = [&](Error error) {
            return error.at({}, line, static_cast<int>(clean.size() - line_start) + 1);
        };
        const std::size_t size = sequenceSize(text.substr(at, 4));
        if (text[at] == '\0') throw place(inputError("NUL byte", "a model is a text file"));
        if (size == 0)
            throw place(inputError(fmt::format("byte 0x{:02x} is no UTF-8", static_cast<unsigned char>(text[at])),
                                   "save the file as UTF-8"));
        if (text[at] == '\r' && text.substr(at, 2) == "\r\n") ++at;
        if (text[at] == '\n' || text[at] == '\r') {
            clean += '\n';
            ++line;
            line_start = clean.size();
            ++at;
            continue;
        }
        clean += text.substr(at, size);
        at += size;
    }
    return clean;
}

std::vector<SourceLine> splitLines(std::string_view text) {
    std::vector<SourceLine> lines;
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        std::size_t first = begin, last = end;
        const auto blank = [&](std::size_t i) { return text[i] == ' ' || text[i] == '\t'; };
        while (first < last && blank(first)) ++first;
        while (last > first && blank(last - 1)) --last;
        lines.push_back({text.substr(first, last - first), static_cast<int>(lines.size()) + 1,
                         static_cast<int>(first - begin) + 1});
        begin = end + 1;
    }
    return lines;
}

}  // namespace searchlight
