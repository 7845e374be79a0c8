// Where points on a surface start before they push each other apart.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/surface_walk.h"
#include "scene/mesh.h"

namespace searchlight {

/// Sum of the triangles' areas.
double surfaceArea(const Mesh& mesh);

/// Independent and uniform over the area. Point i has a random stream of its own.
std::vector<SurfacePlace> randomPlaces(const Mesh& mesh, std::size_t count, std::uint64_t seed, int threads);

/// One place in each of `count` equal parts of the surface, cut along a Hilbert curve: already the right density
/// everywhere, so that only neighbours have to sort themselves out. In the order of the curve.
std::vector<SurfacePlace> stratifiedPlaces(const Mesh& mesh, std::size_t count, std::uint64_t seed, int threads);

}  // namespace searchlight
