// Smooth normals of a mesh.
#pragma once

#include <vector>

#include "scene/mesh.h"

namespace searchlight {

/// One unit normal per vertex: the mean over the triangles around its position, weighted by their angles there
/// [Thurmer1998]; vertices at one position share it, so seams do not show. A vertex whose triangles are all degenerate
/// gets +y.
std::vector<Vec3f> vertexNormals(const Mesh& mesh);

/// Twice the area as the length, along the side from which the corners run counter-clockwise.
Vec3 triangleNormal(const Mesh& mesh, std::size_t triangle);

}  // namespace searchlight
