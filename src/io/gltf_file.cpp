#include "io/gltf_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "base/files.h"
#include "base/text.h"
#include "io/byte_reader.h"
#include "io/shape_formats.h"

namespace searchlight {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::uint32_t kJsonChunk = 0x4E4F534A, kBinaryChunk = 0x004E4942;

struct GlbChunks {
    std::string_view json;
    std::optional<std::string_view> binary;
};

GlbChunks splitGlb(std::string_view bytes, const std::string& path) {
    ByteReader reader(bytes, path, std::endian::little);
    reader.take(4, 1, "magic bytes");
    if (const auto version = reader.value<std::uint32_t>("the version"); version != 2)
        throw reader.error(4, fmt::format("GLB version {}", version), "valid: 2");
    if (const auto size = reader.value<std::uint32_t>("the size of the file"); size != bytes.size())
        throw reader.error(8, fmt::format("states {} bytes, but the file has {}", size, bytes.size()));
    GlbChunks chunks;
    for (bool first = true; reader.left() > 0; first = false) {
        const auto size = reader.value<std::uint32_t>("the size of a chunk");
        const auto type = reader.value<std::uint32_t>("the type of a chunk");
        if (first != (type == kJsonChunk))
            throw reader.error(reader.at() - 4, "the first chunk, and no other, is JSON");
        const std::string_view chunk = reader.take(size, 1, "characters of a chunk");
        if (first) chunks.json = chunk;
        if (type == kBinaryChunk && !chunks.binary) chunks.binary = chunk;
    }
    if (chunks.json.empty()) throw reader.error(12, "no JSON chunk");
    return chunks;
}

std::optional<std::string> decodeBase64(std::string_view text) {
    while (text.ends_with('=')) text.remove_suffix(1);
    std::string bytes;
    bytes.reserve(text.size() / 4 * 3 + 2);
    std::uint32_t bits = 0;
    int have = 0;
    for (const char c : text) {
        static constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
        const std::size_t digit = digits.find(c);
        if (digit == std::string_view::npos) return std::nullopt;
        bits = bits << 6 | static_cast<std::uint32_t>(digit);
        have += 6;
        if (have < 8) continue;
        have -= 8;
        bytes += static_cast<char>(bits >> have & 0xFF);
    }
    return bytes;
}

// "a%20b.bin" -> "a b.bin"
std::string decodePercent(std::string_view text) {
    const auto hex = [](char c) {
        return c >= '0' && c <= '9'   ? c - '0'
               : c >= 'a' && c <= 'f' ? c - 'a' + 10
               : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                      : -1;
    };
    std::string decoded;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] == '%' && i + 2 < text.size() && hex(text[i + 1]) >= 0 && hex(text[i + 2]) >= 0) {
            decoded += static_cast<char>(16 * hex(text[i + 1]) + hex(text[i + 2]));
            i += 2;
        } else {
            decoded += text[i];
        }
    }
    return decoded;
}

// A file in the folder or below, by name alone: no other scheme, root or way up.
bool isBeside(const std::string& uri) {
    const fs::path relative(uri);
    return !uri.empty() && uri.find_first_of(std::string_view(":\\\0", 3)) == std::string::npos &&
           !relative.has_root_path() && std::ranges::find(relative, fs::path("..")) == relative.end();
}

}  // namespace

GltfFile::GltfFile(std::string_view bytes, const std::string& path) : path_(path) {
    std::string_view text = bytes;
    if (bytes.starts_with("glTF")) {
        const GlbChunks chunks = splitGlb(bytes, path);
        text = chunks.json;
        binary_ = chunks.binary;
    }
    json_.emplace(text, path);
    if (!root().is_object()) throw error("", "is no glTF file", "expected an object with asset, meshes, nodes");
    const json asset = root().value("asset", json());
    const json version = asset.is_object() ? asset.value("version", json()) : json();
    if (!version.is_string()) throw error("", "is no glTF file", R"(expected "asset": {"version": "2.0"})");
    if (!version.get<std::string>().starts_with("2."))
        throw error("/asset/version", fmt::format("glTF version {}", version.dump()), "valid: 2.0");
    for (const char* list : {"buffers", "bufferViews", "accessors", "meshes", "nodes", "scenes"})
        if (root().contains(list) && !root()[list].is_array())
            throw error(fmt::format("/{}", list), "is no list", "expected a list of objects");
    loaded_.resize(count("buffers"));
}

std::size_t GltfFile::count(const char* list) const { return root().contains(list) ? root()[list].size() : 0; }

const json& GltfFile::entry(const char* list, std::size_t i, const std::string& user) const {
    if (i >= count(list)) throw error(user, fmt::format("{} of {}", i, list), fmt::format("there are {}", count(list)));
    const json& found = root()[list][i];
    if (!found.is_object()) throw error(fmt::format("/{}/{}", list, i), "is no object");
    return found;
}

std::optional<std::size_t> GltfFile::number(const json& object, const std::string& pointer, const char* key) const {
    const auto found = object.find(key);
    if (found == object.end()) return std::nullopt;
    // No number in a file that is read whole is larger.
    if (!found->is_number_unsigned() || found->get<std::uint64_t>() > kMostShapeBytes)
        throw error(fmt::format("{}/{}", pointer, key),
                    fmt::format("{} is no valid number", found->dump().substr(0, 24)), "a whole number of 0 or more");
    return found->get<std::size_t>();
}

std::size_t GltfFile::requiredNumber(const json& object, const std::string& pointer, const char* key) const {
    if (const std::optional<std::size_t> found = number(object, pointer, key)) return *found;
    throw error(pointer, fmt::format("has no '{}'", key));
}

std::string_view GltfFile::buffer(std::size_t i, const std::string& user) {
    const json& buffer = entry("buffers", i, user);
    const std::string pointer = fmt::format("/buffers/{}", i);
    const std::size_t size = requiredNumber(buffer, pointer, "byteLength");
    std::string_view bytes;
    if (!buffer.contains("uri")) {
        if (i != 0 || !binary_)
            throw error(pointer, "has no 'uri'", "only the first buffer of a .glb file may lack it");
        bytes = *binary_;
    } else {
        if (!loaded_[i]) {
            if (!buffer["uri"].is_string()) throw error(pointer + "/uri", "is no text");
            loaded_[i] = load(buffer["uri"], pointer + "/uri");
            loaded_bytes_ += loaded_[i]->size();
            if (loaded_bytes_ > kMostShapeBytes) throw error(pointer, "all buffers together are larger than 2048 MiB");
        }
        bytes = *loaded_[i];
    }
    if (bytes.size() < size) throw error(pointer, fmt::format("states {} bytes, but has {}", size, bytes.size()));
    return bytes.substr(0, size);
}

std::string GltfFile::load(const std::string& uri, const std::string& pointer) const {
    if (uri.starts_with("data:")) {
        constexpr std::string_view mark = ";base64,";
        const std::size_t at = uri.find(mark);
        if (at == std::string::npos) throw error(pointer, "a data URI that is not base64");
        if (auto bytes = decodeBase64(std::string_view(uri).substr(at + mark.size()))) return std::move(*bytes);
        throw error(pointer, "is damaged base64");
    }
    const std::string name = decodePercent(uri);
    if (!isBeside(name))
        throw error(pointer, fmt::format("'{}' is refused", name.substr(0, 80)),
                    "a file in the same folder or below it");
    try {
        return readFile(fs::path(path_).parent_path() / name, kMostShapeBytes);
    } catch (const Error& missing) {
        throw error(pointer, fmt::format("{}: {}", missing.file, missing.message));
    }
}

}  // namespace searchlight
