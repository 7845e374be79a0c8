#include <fmt/format.h>

#include <bit>

#include "io/shape_formats.h"

namespace searchlight {

namespace {

static_assert(std::endian::native == std::endian::little, "the file is little-endian, and written as memory is");

template <class T>
void append(std::string& bytes, const T& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

std::string properties(std::initializer_list<std::string_view> names) {
    std::string text;
    for (const std::string_view name : names) text += fmt::format("property float {}\n", name);
    return text;
}

}  // namespace

std::string plyBytes(const Mesh& mesh) {
    std::string bytes = fmt::format("ply\nformat binary_little_endian 1.0\nelement vertex {}\n", mesh.positions.size());
    bytes += properties({"x", "y", "z"});
    if (!mesh.normals.empty()) bytes += properties({"nx", "ny", "nz"});
    if (!mesh.uvs.empty()) bytes += properties({"u", "v"});
    bytes +=
        fmt::format("element face {}\nproperty list uchar int vertex_indices\nend_header\n", mesh.triangles.size());
    bytes.reserve(bytes.size() + 32 * mesh.positions.size() + 13 * mesh.triangles.size());
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        append(bytes, mesh.positions[i]);
        if (!mesh.normals.empty()) append(bytes, mesh.normals[i]);
        if (!mesh.uvs.empty()) append(bytes, mesh.uvs[i]);
    }
    for (const std::array<std::uint32_t, 3>& triangle : mesh.triangles) {
        append(bytes, std::uint8_t{3});
        append(bytes, triangle);
    }
    return bytes;
}

std::string plyBytes(const PointCloud& cloud) {
    std::string bytes =
        fmt::format("ply\nformat binary_little_endian 1.0\nelement vertex {}\n", cloud.positions.size());
    bytes += properties({"x", "y", "z"});
    if (!cloud.normals.empty()) bytes += properties({"nx", "ny", "nz"});
    if (!cloud.areas.empty()) bytes += properties({"area"});
    bytes += "end_header\n";
    bytes.reserve(bytes.size() + 28 * cloud.positions.size());
    for (std::size_t i = 0; i < cloud.positions.size(); ++i) {
        append(bytes, cloud.positions[i]);
        if (!cloud.normals.empty()) append(bytes, cloud.normals[i]);
        if (!cloud.areas.empty()) append(bytes, cloud.areas[i]);
    }
    return bytes;
}

}  // namespace searchlight
