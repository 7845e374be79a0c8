#include "gl/compile_log.h"

#include <charconv>

#include "base/text.h"

namespace searchlight::gl {

namespace {

// Takes things from the front of a line, or fails and stays failed.
struct Reader {
    std::string_view rest;
    bool good = true;

    int number() {
        int value = 0;
        const auto [end, code] = std::from_chars(rest.data(), rest.data() + rest.size(), value);
        good = good && code == std::errc();
        if (good) rest.remove_prefix(static_cast<std::size_t>(end - rest.data()));
        return value;
    }
    Reader& expect(std::string_view text) {
        good = good && rest.starts_with(text);
        if (good) rest.remove_prefix(text.size());
        return *this;
    }
};

// A message in one driver's shape; nothing when the line has another.
bool readMesa(std::string_view line, CompileMessage& message) {
    Reader reader{line};
    reader.number();
    message.line = reader.expect(":").number();
    message.column = reader.expect("(").number();
    reader.expect("): error: ");
    message.text = reader.rest;
    return reader.good;
}

bool readNvidia(std::string_view line, CompileMessage& message) {
    Reader reader{line};
    reader.number();
    message.line = reader.expect("(").number();
    message.column = 0;
    reader.expect(") : error ");
    const std::size_t colon = reader.rest.find(": ");  // after the code, such as C1008
    if (!reader.good || colon == line.npos) return false;
    message.text = reader.rest.substr(colon + 2);
    return true;
}

bool readAmd(std::string_view line, CompileMessage& message) {
    Reader reader{line};
    reader.expect("ERROR: ").number();
    message.line = reader.expect(":").number();
    message.column = 0;
    message.text = trim(reader.expect(":").rest);
    return reader.good;
}

bool readPlaceless(std::string_view line, CompileMessage& message) {
    Reader reader{line};
    message = {0, 0, std::string(trim(reader.expect("error:").rest))};
    return reader.good;
}

}  // namespace

std::vector<CompileMessage> compileErrors(std::string_view log) {
    std::vector<CompileMessage> errors;
    for (const std::string_view line : split(log, '\n')) {
        CompileMessage message;
        const std::string_view text = trim(line);
        if (readMesa(text, message) || readNvidia(text, message) || readAmd(text, message) ||
            readPlaceless(text, message))
            errors.push_back(std::move(message));
    }
    return errors;
}

}  // namespace searchlight::gl
