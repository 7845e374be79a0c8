// Random points of a surface, each as likely as its neighbour by area, and no two far from even.
#pragma once

#include <cstdint>
#include <vector>

#include "base/vec.h"
#include "geometry/surface_walk.h"
#include "scene/mesh.h"

namespace searchlight {

struct ChosenPoints {
    std::vector<Vec3f> positions;
    std::vector<Vec3f> normals;  ///< for shading
};

/// Draws anew each time, unlike samplePoints(), whose points push each other apart and so have no density that is
/// known. Keeps a reference to the walk's mesh.
class EvenPoints {
public:
    EvenPoints(const Mesh& mesh, const SurfaceWalk& walk);

    double area() const { return cumulative_.back(); }  ///< mm^2

    /// `count` points, one in each of as many parts of equal area along a curve through the triangles: together their
    /// density is count / area() everywhere, for every seed apart.
    ChosenPoints draw(std::size_t count, std::uint64_t seed) const;

private:
    const SurfaceWalk& walk_;
    std::vector<std::uint32_t> order_;  ///< triangles along a Morton curve
    std::vector<double> cumulative_;    ///< their areas, from 0
};

}  // namespace searchlight
