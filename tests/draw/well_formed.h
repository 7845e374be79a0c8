// Is a text well-formed XML? Enough of the grammar for what this program writes: elements, attributes, entities.
#pragma once

#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace searchlight {

/// Empty when well-formed, otherwise what is wrong and where. `void_elements` need no end (HTML).
inline std::string xmlProblem(std::string_view text, const std::set<std::string, std::less<>>& void_elements = {}) {
    const auto badReference = [](std::string_view part) {
        for (size_t at = part.find('&'); at != std::string_view::npos; at = part.find('&', at + 1)) {
            const std::string_view name = part.substr(at, part.substr(at).find(';') + 1);
            if (name != "&amp;" && name != "&lt;" && name != "&gt;" && name != "&quot;") return true;
        }
        return false;
    };
    std::vector<std::string> open;
    bool root = false;
    while (!text.empty()) {
        const size_t begin = text.find('<');
        const std::string_view content = text.substr(0, begin);
        if (badReference(content)) return "bad reference in: " + std::string(content);
        if (begin == std::string_view::npos) break;
        if (open.empty() && root && text.substr(begin, 2) != "<!") return "a second root";
        text.remove_prefix(begin);
        const size_t end = text.find('>');
        if (end == std::string_view::npos) return "a tag without end";
        std::string_view tag = text.substr(1, end - 1);
        text.remove_prefix(end + 1);
        if (tag.starts_with('?') || tag.starts_with('!')) continue;
        if (tag.starts_with('/')) {
            if (open.empty() || open.back() != tag.substr(1)) return "unexpected end of " + std::string(tag);
            open.pop_back();
            root = open.empty();
            continue;
        }
        const bool closed = tag.ends_with('/');
        if (closed) tag.remove_suffix(1);
        const std::string name(tag.substr(0, tag.find(' ')));
        tag.remove_prefix(name.size());
        std::set<std::string, std::less<>> attributes;
        while (tag.find_first_not_of(" \n") != std::string_view::npos) {
            tag.remove_prefix(tag.find_first_not_of(" \n"));
            const size_t equals = tag.find("=\"");
            if (equals == std::string_view::npos) return "attribute without value in " + name;
            const size_t close = tag.find('"', equals + 2);
            if (close == std::string_view::npos) return "attribute without end in " + name;
            const std::string_view value = tag.substr(equals + 2, close - equals - 2);
            if (value.find('<') != std::string_view::npos || badReference(value)) return "bad attribute in " + name;
            if (!attributes.emplace(tag.substr(0, equals)).second) return "attribute twice in " + name;
            tag.remove_prefix(close + 1);
        }
        if (!closed && !void_elements.contains(name)) open.push_back(name);
    }
    return open.empty() ? "" : "not ended: " + open.back();
}

}  // namespace searchlight
