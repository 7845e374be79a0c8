// Texture coordinates that came with a mesh: whether every place on the surface has a place of its own in them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "geometry/atlas/surface_graph.h"

namespace searchlight {

/// Why a mesh's own uvs cannot carry an atlas, in half a sentence with numbers: they are missing, not finite, outside
/// the unit square, degenerate, turned over, or lie over one another. Empty: they can. `surface` is of the same mesh.
std::string faultOfUvs(const Mesh& mesh, const SurfaceGraph& surface);

/// The chart of each triangle: connected over sides that have equal uvs in both triangles. no_triangle for a triangle
/// without area.
std::vector<std::uint32_t> chartsOfUvs(const Mesh& mesh, const SurfaceGraph& surface);

}  // namespace searchlight
