// A closed mesh around what an implicit function says is inside.
#pragma once

#include <functional>

#include "scene/mesh.h"

namespace searchlight {

struct PolygoniseOptions {
    Vec3 low, high;        ///< nothing inside reaches the sides of this box
    double cell = 0.01;    ///< size of the cubes that are cut
    double lipschitz = 1;  ///< |f(a) - f(b)| is at most this times |a - b|: what is skipped is sure to be empty
    int smoothing = 4;     ///< rounds that even the triangles out and draw them onto the surface
    int threads = 0;
    /// Whether the surface keeps away from the ball; where it is given, `lipschitz` decides nothing of what is skipped.
    std::function<bool(Vec3 middle, double radius)> empty;
};

/// The surface f = 0 of a function that is negative inside and near a distance close to the surface; called from many
/// threads. Marching tetrahedra [Doi1991], so that every edge has two triangles whatever f does between its samples;
/// parts thinner than a cell may get lost. Where f is NaN there is no surface: it ends there. Normals are the
/// function's, uvs are left empty.
Mesh polygonise(const std::function<double(Vec3)>& f, const PolygoniseOptions& options);

}  // namespace searchlight
