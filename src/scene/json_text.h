// JSON with places: nlohmann::json beside the line and column of every value, so that an error about meaning can point
// into the file as an error of syntax does. Include it from .cpp files only.
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "base/error.h"
#include "base/param.h"
#include "scene/scene.h"

namespace searchlight {

class JsonText {
public:
    /// Parses. Throws an input Error with file, line and column for a syntax error, a key that stands twice in one
    /// object, a number beyond double, or nesting deeper than 64.
    JsonText(std::string_view text, std::string_view path);

    const nlohmann::json& root() const { return root_; }

    /// An input Error at the value of that JSON pointer ("/lights/0/direction"), or at its key; the message names it.
    Error error(const std::string& pointer, std::string_view message, std::string hint = {}) const;
    Error errorAtKey(const std::string& pointer, std::string_view message, std::string hint = {}) const;

    /// `json`, which stands at `pointer`, as the Param's type, its range checked.
    ParamValue value(const std::string& pointer, const nlohmann::json& json, const Param& param) const;

private:
    struct Place {
        std::size_t key = 0, value = 0;  ///< offsets in bytes
    };

    Error at(std::size_t offset, std::string message, std::string hint) const;
    std::size_t scanValue(std::size_t offset, const std::string& pointer, int depth);
    std::size_t scanMembers(std::size_t offset, const std::string& pointer, int depth);

    std::string text_, path_;
    nlohmann::json root_;
    std::map<std::string, Place> places_;
};

/// The scene that stands at a pointer of a larger document ("" for the document itself); within one, its "format" may
/// be absent. Throws as parseScene.
Scene readScene(const JsonText& text, const std::string& pointer);

/// `key` as one step of a JSON pointer.
std::string pointerStep(std::string_view key);

}  // namespace searchlight
