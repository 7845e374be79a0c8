// A convex region without surface around a point of a body that is near its surface: a ball, cut by planes.
#pragma once

#include <array>
#include <vector>

#include "transport/mesh/near_triangles.h"

namespace searchlight {

/// Where |p - middle| < radius and normals[i] . (p - middle) < offsets[i] for the first `planes` of them.
struct CutBall {
    static constexpr int kMostPlanes = 2;
    static constexpr double kNormal = 511;  ///< the components of a normal are whole numbers up to this; its length

    double radius = 0;  ///< mm; 0: there is none
    int planes = 0;
    std::array<Vec3, kMostPlanes> normals;
    std::array<double, kMostPlanes> offsets{};  ///< kNormal mm
};

/// Finds regions for the cells of a grid, cubes of the side `cell`, and for flights of that mean length; mm. Refers to
/// the triangles; one for each thread.
class CutBallChooser {
public:
    CutBallChooser(const NearTriangles& triangles, double cell, double mfp);

    /// The best of several for the cell about a point. `bound`: at most the distance of any point of the cell from the
    /// surface.
    CutBall choose(Vec3 middle, double bound);

private:
    struct Triangle {
        double distance;
        std::array<Vec3, 3> corners;  // from the middle of the cell
        Vec3 normal;                  // of a plane that it may ask for
    };

    CutBall cut(double radius, double tolerance, Vec3 inside) const;
    double uncleared(const CutBall& region, Vec3 from) const;

    const NearTriangles& triangles_;
    double cell_, mfp_, half_diagonal_;
    std::vector<NearTriangles::Near> found_;
    std::vector<Triangle> near_;  // by distance
};

}  // namespace searchlight
