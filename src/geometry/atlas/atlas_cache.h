// Atlases on disk, so that a surface is laid flat once. The format is in docs/texture-space.md.
#pragma once

#include <string>

#include "base/cache_folder.h"
#include "geometry/atlas/atlas.h"

namespace searchlight {

/// The folder that holds `points` holds atlases as well, with an ending and a size of their own.
CacheFolder atlasesBeside(const CacheFolder& points);

/// The file of this atlas: its name is a hash of the mesh, the options but threads, and the version of the method.
std::filesystem::path atlasFile(const CacheFolder& cache, const std::string& content_hash, const AtlasOptions& options);

/// Reads the atlas, or makes and writes it; bit for bit the same either way. A damaged file is made again; that, and a
/// folder that cannot be written, is logged as a warning. Processes may share a folder. `content_hash` is Object's.
/// Throws what makeAtlas throws.
Atlas cachedAtlas(const Mesh& mesh, const std::string& content_hash, const AtlasOptions& options,
                  const CacheFolder& cache, Observer& observer);

}  // namespace searchlight
