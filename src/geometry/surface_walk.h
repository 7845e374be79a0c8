// Moving about on a mesh: straight on within a triangle, folded over at its edges.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "scene/mesh.h"

namespace searchlight {

/// A place on a mesh: position = (1 - u - v) p0 + u p1 + v p2 of a triangle.
struct SurfacePlace {
    std::uint32_t triangle = 0;
    double u = 0, v = 0;
};

/// Keeps a reference to the mesh. All members may be called from many threads at once.
class SurfaceWalk {
public:
    explicit SurfaceWalk(const Mesh& mesh);

    Vec3 position(const SurfacePlace& place) const;
    /// Unit, of the triangle; zero for one without area.
    Vec3 normal(std::uint32_t triangle) const { return toDouble(normals_[triangle]); }
    /// Of the vertices where the mesh has them, else of the triangle; unit.
    Vec3 shadingNormal(const SurfacePlace& place) const;

    /// Goes `step` along the surface, which is flattened on the way [Turk1992]; what sticks out of the triangle's plane
    /// is ignored. At an open edge it slides along it.
    SurfacePlace move(SurfacePlace place, Vec3 step) const;

private:
    const Mesh& mesh_;
    std::vector<std::array<std::uint32_t, 3>> neighbours_;
    std::vector<Vec3f> normals_;
};

}  // namespace searchlight
