// What a glTF file is made of before it means anything: JSON, and buffers of bytes. For src/io alone.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/json_text.h"

namespace searchlight {

/// A .gltf or .glb file; which one it is, its first bytes say. Its errors name a JSON pointer where there is one.
class GltfFile {
public:
    /// Throws an input Error for what is no glTF 2.0 file. `bytes` must outlive the object.
    GltfFile(std::string_view bytes, const std::string& path);

    const nlohmann::json& root() const { return json_->root(); }
    Error error(const std::string& pointer, std::string_view message, std::string hint = {}) const {
        return json_->error(pointer, message, std::move(hint));
    }

    /// How many entries the list of that name has at the root; 0 without it.
    std::size_t count(const char* list) const;

    /// Entry i of a list at the root, an object. An input Error at `user`, the pointer of what refers to it, when there
    /// is none.
    const nlohmann::json& entry(const char* list, std::size_t i, const std::string& user) const;

    /// A whole number of 0 or more of `object`, which stands at `pointer`; nothing when it has no such key.
    std::optional<std::size_t> number(const nlohmann::json& object, const std::string& pointer, const char* key) const;
    std::size_t requiredNumber(const nlohmann::json& object, const std::string& pointer, const char* key) const;

    /// The bytes of a buffer: of the binary chunk, of a data URI, or of a file beside the glTF file, never above its
    /// folder. Read once, when asked for.
    std::string_view buffer(std::size_t i, const std::string& user);

private:
    std::string load(const std::string& uri, const std::string& pointer) const;

    std::string path_;
    std::optional<JsonText> json_;
    std::optional<std::string_view> binary_;
    std::vector<std::optional<std::string>> loaded_;
    std::size_t loaded_bytes_ = 0;
};

}  // namespace searchlight
