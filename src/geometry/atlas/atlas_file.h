// An atlas as the bytes of a file. The format is in docs/texture-space.md.
#pragma once

#include <string>
#include <string_view>

#include "geometry/atlas/atlas.h"

namespace searchlight {

/// A checksum ends them.
std::string atlasBytes(const Atlas& atlas);

/// Throws an input Error that names `path` for anything else than what atlasBytes() gave for a mesh of that many
/// `triangles` and that `resolution`.
Atlas parseAtlas(std::string_view bytes, const std::string& path, std::size_t triangles, int resolution);

}  // namespace searchlight
