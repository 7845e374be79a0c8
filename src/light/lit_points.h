// Surface points made ready for light: what is done once per set of points, and not again when the light moves.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/observer.h"
#include "base/vec.h"
#include "geometry/object.h"
#include "geometry/rays.h"

namespace searchlight {

struct SurfacePoints {
    std::span<const Vec3f> positions;  ///< mm, in the object's place
    std::span<const Vec3f> normals;    ///< unit, for shading
};

enum class LitNormals {
    shading,    ///< those of the points; shadows are those of the smooth surface that such normals speak of
    geometric,  ///< of the triangles: what a random walk through the mesh meets, so what it is compared with
};

/// The points along a space-filling curve, so that neighbours trace coherent rays, and where their shadow rays start.
///
/// The cosine and T12 take one normal, visibility the real triangles. With shading normals a ray that starts on a flat
/// triangle would put the triangles at the edge of the light into their own shadow, one by one; so it starts on the
/// smooth surface instead that the corners' normals span above a convex triangle [Hanika2021]: there the light ends
/// where the cosine does. Concave triangles, and points above which something lies closer than that, are not lifted.
struct LitPoints {
    std::vector<std::uint32_t> order;  ///< element i is point order[i] of the caller
    std::vector<Vec3f> positions;      ///< as given
    std::vector<Vec3f> normals;        ///< for cosine and T12
    std::vector<Vec3f> origins;        ///< of shadow rays; already off the surface
    double spacing_mm = 0;             ///< side of the square that a point stands for

    std::size_t size() const { return order.size(); }
};

/// `rays` made of object.mesh, triangle by triangle; null: nothing will cast shadows, and geometric normals need it.
/// Points of a cloud, which lie beside the surface through it, start above it by their spacing.
/// The result does not depend on `threads` (0: all). Throws interruptedError() when cancelled.
LitPoints prepareLitPoints(const SurfacePoints& points, const Object& object, const RayScene* rays, LitNormals normals,
                           int threads, Observer& observer);

}  // namespace searchlight
