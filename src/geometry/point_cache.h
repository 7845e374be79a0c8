// Points of a mesh on disk, as PTC clouds, so that a surface is sampled once.
#pragma once

#include <filesystem>
#include <string>

#include "base/cache_folder.h"
#include "base/observer.h"
#include "geometry/surface_points.h"

namespace searchlight {

/// "points" below the user's cache folder, 512 MiB: 20 million points. Throws as userCacheFolder.
CacheFolder userPointCache();

/// The file of these points: its name is a hash of the mesh, the options but threads, and the version of the methods.
std::filesystem::path pointFile(const CacheFolder& cache, const std::string& content_hash, const PointOptions& options);

struct CachedPoints {
    PointCloud cloud;
    bool hit = false;            ///< read, not sampled
    std::filesystem::path file;  ///< where it is kept; may not exist, if the folder cannot be written
};

/// Reads the points, or samples and writes them. A file has its normals in 2 x 16 bits (1e-4); what was just sampled is
/// read back, so that a picture is the same either way. A damaged file is made again; that, and a folder that cannot be
/// written, is logged as a warning. `content_hash` is Object's. Throws what samplePoints throws.
CachedPoints cachedPoints(const Mesh& mesh, const std::string& content_hash, const PointOptions& options,
                          const CacheFolder& cache, Observer& observer);

}  // namespace searchlight
