#include "scene/json_text.h"

#include <fmt/format.h>

#include <algorithm>

namespace searchlight {

namespace {

constexpr int max_depth = 64;  // of nesting: deeper is an attack on the stack, not a scene

// What is wrong, out of "[json.exception.parse_error.101] parse error at line 1, column 2: syntax error while parsing
// value - unexpected ','; last read: ','". What was read last is left out: it may be no valid text.
std::string detail(std::string_view what) {
    what = what.substr(0, what.find("; last read"));
    const std::size_t dash = what.find(" - ");
    return std::string(dash == std::string_view::npos ? what : what.substr(dash + 3));
}

bool numeric(const nlohmann::json& value) {
    return value.is_array() && std::ranges::all_of(value, [](const nlohmann::json& part) { return part.is_number(); });
}

// The offset behind the string whose opening quote stands at `offset`.
std::size_t endOfString(std::string_view text, std::size_t offset) {
    for (++offset; text[offset] != '"'; ++offset)
        if (text[offset] == '\\') ++offset;
    return offset + 1;
}

}  // namespace

JsonText::JsonText(std::string_view text, std::string_view path) : text_(text), path_(path) {
    if (text_.starts_with("\xEF\xBB\xBF")) text_.erase(0, 3);
    try {
        root_ = nlohmann::json::parse(text_);
    } catch (const nlohmann::json::parse_error& error) {
        throw at(error.byte > 0 ? error.byte - 1 : 0, "not valid JSON: " + detail(error.what()), {});
    } catch (const nlohmann::json::out_of_range& error) {
        // "number overflow parsing '1e999'": the library does not say where.
        const std::string_view what = error.what();
        const std::size_t first = what.find('\'') + 1;
        const std::string_view number = what.substr(first, what.rfind('\'') - first);
        throw at(text_.find(number), fmt::format("the number {} is too large", number), {});
    }
    scanValue(0, "", 0);
}

Error JsonText::at(std::size_t offset, std::string message, std::string hint) const {
    const std::string_view before = std::string_view(text_).substr(0, std::min(offset, text_.size()));
    const std::size_t line_start = before.rfind('\n') + 1;  // npos + 1 is 0
    return inputError(std::move(message), std::move(hint))
        .at(path_, static_cast<int>(std::ranges::count(before, '\n')) + 1,
            static_cast<int>(before.size() - line_start) + 1);
}

Error JsonText::error(const std::string& pointer, std::string_view message, std::string hint) const {
    const auto place = places_.find(pointer);
    return at(place == places_.end() ? 0 : place->second.value,
              pointer.empty() ? std::string(message) : fmt::format("{}: {}", pointer, message), std::move(hint));
}

ParamValue JsonText::value(const std::string& pointer, const nlohmann::json& json, const Param& param) const {
    ParamValue read;
    if (json.is_boolean())
        read = json.get<bool>();
    else if (json.is_string())
        read = json.get<std::string>();
    else if (json.is_number() && param.type == ParamType::color)
        read = Rgb{json.get<double>(), json.get<double>(), json.get<double>()};
    else if (json.is_number() && (param.type == ParamType::channels || param.type == ParamType::numbers))
        read = std::vector<double>{json.get<double>()};
    else if (json.is_number())
        read = json.get<double>();
    else if (numeric(json) && json.size() == 3 && param.type == ParamType::color)
        read = Rgb{json[0].get<double>(), json[1].get<double>(), json[2].get<double>()};
    else if (numeric(json))
        read = json.get<std::vector<double>>();
    else
        throw error(pointer, fmt::format("{} is no value", json.is_object() ? "an object" : json.dump()),
                    "expected " + rangeText(param));
    try {
        checkValue(param, read);
    } catch (const Error& bad) {
        throw error(pointer, bad.message, bad.hint);
    }
    return read;
}

Error JsonText::errorAtKey(const std::string& pointer, std::string_view message, std::string hint) const {
    const auto place = places_.find(pointer);
    return at(place == places_.end() ? 0 : place->second.key, fmt::format("{}: {}", pointer, message), std::move(hint));
}

// The text is known to be valid JSON from here on, so the scan only has to find the ends of things.
std::size_t JsonText::scanValue(std::size_t offset, const std::string& pointer, int depth) {
    offset = text_.find_first_not_of(" \t\r\n", offset);
    places_[pointer].value = offset;
    if (depth > max_depth) throw at(offset, fmt::format("nested deeper than {}", max_depth), {});
    const char first = text_[offset];
    if (first == '{' || first == '[') return scanMembers(offset, pointer, depth);
    if (first == '"') return endOfString(text_, offset);
    return std::min(text_.find_first_of(" \t\r\n,]}", offset), text_.size());
}

std::size_t JsonText::scanMembers(std::size_t offset, const std::string& pointer, int depth) {
    const bool object = text_[offset] == '{';
    for (std::size_t index = 0;; ++index) {
        offset = text_.find_first_not_of(" \t\r\n,", offset + 1);
        if (text_[offset] == '}' || text_[offset] == ']') return offset + 1;
        const std::size_t key_offset = offset;
        std::string member = fmt::format("{}/{}", pointer, index);
        if (object) {
            offset = endOfString(text_, offset);
            const std::string key = nlohmann::json::parse(text_.substr(key_offset, offset - key_offset));
            member = pointer + pointerStep(key);
            if (places_.contains(member)) throw at(key_offset, fmt::format("{}: the key stands twice", member), {});
            offset = text_.find(':', offset) + 1;
        }
        places_[member].key = key_offset;
        offset = scanValue(offset, member, depth + 1) - 1;
    }
}

std::string pointerStep(std::string_view key) {
    std::string step = "/";
    for (const char c : key) {
        if (c == '~')
            step += "~0";
        else if (c == '/')
            step += "~1";
        else
            step += c;
    }
    return step;
}

}  // namespace searchlight
