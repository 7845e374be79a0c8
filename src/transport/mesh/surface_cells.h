// The receivers of a reference: a surface cut into cells of about one area, each the same set of points for walks and
// for models.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/vec.h"
#include "scene/mesh.h"

namespace searchlight {

/// Points by which a model is averaged over the cells that walks are averaged over: uniform within each cell.
struct CellPoints {
    std::vector<std::uint32_t> cells;
    std::vector<std::uint32_t> triangles;
    std::vector<Vec3f> positions;
    std::vector<Vec3f> normals;  ///< geometric
};

/// Cells of a mesh: clusters of small triangles, parts of large ones. Every point of a triangle is in one cell.
class SurfaceCells {
public:
    SurfaceCells() = default;
    /// Cells of at most about area_mm2 (0: one per triangle). Throws an input Error for more than 2^24 of them, which a
    /// picture could no longer number.
    SurfaceCells(const Mesh& mesh, double area_mm2);

    std::size_t size() const { return areas_.size(); }
    const std::vector<double>& areas_mm2() const { return areas_; }

    /// The cell of the point (1 - u - v) p0 + u p1 + v p2 of a triangle.
    std::uint32_t at(std::uint32_t triangle, float u, float v) const;
    /// Asks the memory for what at() will read.
    void seek(std::uint32_t triangle) const;

    /// As many points in every cell (rounding may take or add one), of the mesh that the cells were made from.
    CellPoints sample(const Mesh& mesh, int per_cell, std::uint64_t seed) const;

private:
    struct Part {
        std::uint32_t first = 0;  ///< cell; of the parts of a triangle the first
        std::uint32_t sides = 1;  ///< its sides are cut into so many, the triangle into the square of that
    };

    std::vector<Part> parts_;  ///< per triangle
    std::vector<double> areas_;
};

/// Cells of equal area on a sphere about the origin: rows of equal height along y, each cut into the same columns.
struct SphereCells {
    double radius_mm = 1;
    int rows = 1, columns = 1;

    std::size_t size() const { return static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns); }
    double area_mm2() const;
    /// The cell of a point's direction from the centre; row 0 is around +y.
    std::uint32_t at(Vec3 position) const;
};

/// Cells of about area_mm2, twice as many columns as rows.
SphereCells makeSphereCells(double radius_mm, double area_mm2);

/// The mean over each cell's points of a value per point.
std::vector<Rgb> averageOverCells(const CellPoints& points, std::span<const Rgbf> values, std::size_t cells);

/// Area of a triangle, mm^2.
double triangleArea(const Mesh& mesh, std::size_t triangle);

/// Outward unit normal of a triangle, by its orientation; of a triangle without area, zero.
Vec3 unitNormal(const Mesh& mesh, std::size_t triangle);

}  // namespace searchlight
