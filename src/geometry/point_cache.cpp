#include "geometry/point_cache.h"

#include <fmt/format.h>

#include <cmath>

#include "base/error.h"
#include "base/files.h"
#include "geometry/content_hash.h"
#include "geometry/point_start.h"
#include "io/shape_file.h"

namespace searchlight {

namespace {

// Counted up whenever the same options give other points.
constexpr std::uint64_t method_version = 2;

// Of a point in a file: position, normal, radius and area.
constexpr std::uintmax_t bytes_per_point = 24;

// PTC has no checksum: a file of another length is refused by its reader, and areas that do not sum to the mesh's show
// most of what else can happen to it.
PointCloud readPoints(const std::filesystem::path& file, const Mesh& mesh, std::size_t count) {
    PointCloud cloud = readPointCloud(file.string());
    double sum = 0;
    for (const float area : cloud.areas) sum += area;
    if (cloud.positions.size() != count || cloud.normals.size() != count || cloud.areas.size() != count ||
        !(std::abs(sum / surfaceArea(mesh) - 1) < 1e-5))
        throw inputError("these are not the points that its name says").at(file.string());
    return cloud;
}

}  // namespace

CacheFolder userPointCache() {
    return {.folder = userCacheFolder("points") / "points", .ending = ".ptc", .max_bytes = std::uintmax_t{1} << 29};
}

std::filesystem::path pointFile(const CacheFolder& cache, const std::string& content_hash,
                                const PointOptions& options) {
    ContentHash hash;
    hash.take(content_hash);
    for (const std::uint64_t word :
         {std::uint64_t{options.count}, static_cast<std::uint64_t>(options.method), options.seed, method_version})
        hash.take(word);
    return cache.folder / (hash.text() + cache.ending);
}

CachedPoints cachedPoints(const Mesh& mesh, const std::string& content_hash, const PointOptions& options,
                          const CacheFolder& cache, Observer& observer) {
    CachedPoints cached;
    cached.file = pointFile(cache, content_hash, options);
    std::error_code error;
    if (std::filesystem::exists(cached.file, error)) try {
            cached.cloud = readPoints(cached.file, mesh, options.count);
            touchFile(cached.file);
            cached.hit = true;
            return cached;
        } catch (const Error& unusable) {
            observer.log(LogLevel::warning, fmt::format("{}; the points are made again", unusable.what()));
        }
    cached.cloud = samplePoints(mesh, options, observer);
    if (options.count == 0 || options.count * bytes_per_point > cache.max_bytes) return cached;
    try {
        makeFolder(cache.folder);
        writePointCloud(cached.file.string(), cached.cloud);
        makeRoom(cache, cached.file);
        cached.cloud = readPoints(cached.file, mesh, options.count);
    } catch (const Error& unwritten) {
        observer.log(LogLevel::warning, fmt::format("the points are not kept: {}", unwritten.what()));
    }
    return cached;
}

}  // namespace searchlight
