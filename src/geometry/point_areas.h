// The part of a surface that each point on it stands for.
#pragma once

#include <span>
#include <vector>

#include "geometry/surface_walk.h"
#include "scene/mesh.h"

namespace searchlight {

/// Area of the surface that is nearest to each point: triangles are cut into pieces, 16 or more for each point, and a
/// piece goes to the nearest point whose side of the surface is not the opposite one. The areas sum to the mesh's
/// within rounding; the result does not depend on threads. Requires positions[i] to lie at places[i].
std::vector<float> nearestAreas(const Mesh& mesh, const SurfaceWalk& walk, std::span<const SurfacePlace> places,
                                std::span<const Vec3f> positions, int threads);

}  // namespace searchlight
