// The triangles near a point, for tables that are built once for a mesh.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "scene/mesh.h"

namespace searchlight {

/// Triangles by where their middles are; those much larger than the bins stand apart. Refers to the mesh.
class NearTriangles {
public:
    /// Bins of that side, mm: about as far as queries will reach.
    NearTriangles(const Mesh& mesh, double side);

    struct Near {
        std::uint32_t triangle;
        double distance;  ///< at most that of the triangle from the point, mm
    };

    /// Finds all that may be nearer than the radius.
    void find(Vec3 p, double radius, std::vector<Near>& found) const;

    /// Outward; its length is twice the area.
    Vec3 normal(std::uint32_t triangle) const { return normals_[triangle]; }
    /// Unit: the mean of the normals at its corners.
    Vec3 smoothNormal(std::uint32_t triangle) const { return smooth_normals_[triangle]; }
    std::array<Vec3, 3> corners(std::uint32_t triangle) const;

private:
    struct Sphere {
        Vec3 centre;
        double radius = 0;
        std::uint32_t triangle = 0;
    };

    int clamped(double x, int n) const;
    std::size_t binOf(const Sphere& sphere) const;

    const Mesh& mesh_;
    double side_, largest_ = 0;  ///< of the bins; radius of the largest sphere in them
    Vec3 low_;
    int nx_ = 1, ny_ = 1, nz_ = 1;
    std::vector<Vec3> normals_, smooth_normals_;
    std::vector<std::uint32_t> first_;
    std::vector<Sphere> spheres_, large_;  ///< around triangles: bin after bin, and those that are in none
};

}  // namespace searchlight
