#include "geometry/atlas/atlas_cache.h"

#include <fmt/format.h>

#include <bit>

#include "base/error.h"
#include "base/files.h"
#include "geometry/atlas/atlas_file.h"
#include "geometry/content_hash.h"

namespace searchlight {

namespace {

// Counted up whenever the same options give another atlas.
constexpr std::uint64_t method_version = 1;

}  // namespace

CacheFolder atlasesBeside(const CacheFolder& points) {
    return {.folder = points.folder, .ending = ".atlas", .max_bytes = std::uintmax_t{1} << 28};
}

std::filesystem::path atlasFile(const CacheFolder& cache, const std::string& content_hash,
                                const AtlasOptions& options) {
    ContentHash hash;
    hash.take(content_hash);
    for (const std::uint64_t word :
         {static_cast<std::uint64_t>(options.resolution), static_cast<std::uint64_t>(options.gutter),
          std::bit_cast<std::uint64_t>(options.stretch), std::uint64_t{options.conformal},
          static_cast<std::uint64_t>(options.uvs), method_version})
        hash.take(word);
    return cache.folder / (hash.text() + cache.ending);
}

Atlas cachedAtlas(const Mesh& mesh, const std::string& content_hash, const AtlasOptions& options,
                  const CacheFolder& cache, Observer& observer) {
    const std::filesystem::path file = atlasFile(cache, content_hash, options);
    std::error_code error;
    if (std::filesystem::exists(file, error)) try {
            Atlas atlas = parseAtlas(readFile(file), file.string(), mesh.triangles.size(), options.resolution);
            touchFile(file);
            return atlas;
        } catch (const Error& unusable) {
            observer.log(LogLevel::warning, fmt::format("{}; the atlas is made again", unusable.what()));
        }
    Atlas atlas = makeAtlas(mesh, options, observer);
    const std::string bytes = atlasBytes(atlas);
    if (bytes.size() > cache.max_bytes) return atlas;
    try {
        makeFolder(cache.folder);
        writeFile(file, bytes);
        makeRoom(cache, file);
    } catch (const Error& unwritten) {
        observer.log(LogLevel::warning, fmt::format("the atlas is not kept: {}", unwritten.what()));
    }
    return atlas;
}

}  // namespace searchlight
