#include "geometry/content_hash.h"

#include <fmt/format.h>

#include <cstring>

namespace searchlight {

void ContentHash::take(std::string_view bytes) {
    while (!bytes.empty()) {
        std::uint64_t word = 0;
        const std::size_t size = std::min(bytes.size(), sizeof word);
        std::memcpy(&word, bytes.data(), size);
        take(word);
        bytes.remove_prefix(size);
    }
}

std::string ContentHash::text() const { return fmt::format("{:016x}{:016x}", a_, b_); }

std::string contentHash(const Mesh& mesh) {
    ContentHash hash;
    hash.takeList(mesh.positions);
    hash.takeList(mesh.normals);
    hash.takeList(mesh.uvs);
    hash.takeList(mesh.triangles);
    return hash.text();
}

std::string contentHash(const PointCloud& cloud) {
    ContentHash hash;
    hash.takeList(cloud.positions);
    hash.takeList(cloud.normals);
    hash.takeList(cloud.areas);
    return hash.text();
}

}  // namespace searchlight
