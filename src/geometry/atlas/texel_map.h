// The surface by texels: what of it lies in each.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/atlas/atlas.h"
#include "scene/point_cloud.h"

namespace searchlight {

/// What of a chart lies in a texel: the exact area, to the last sliver at the border of the chart, so that the areas
/// add up to the surface's and no seam is counted twice or left out. A texel that several charts touch, which those of
/// a file may, has a cell for each.
struct TexelMap {
    /// Of one triangle in a cell.
    struct Piece {
        std::uint32_t triangle = 0;
        float until = 0;  ///< area of the cell up to and with this piece, mm^2
    };

    int resolution = 0;
    PointCloud cells;  ///< along the Z-order curve of their texels: a place on the surface near the middle, its shading
                       ///< normal, the area in mm^2
    std::vector<std::uint32_t> texels;       ///< of each cell: y * resolution + x
    std::vector<std::uint32_t> first_piece;  ///< of each cell; one more at the end
    std::vector<Piece> pieces;

    std::size_t size() const { return texels.size(); }
};

/// `mesh` with normals, and its atlas.
TexelMap mapTexels(const Mesh& mesh, const Atlas& atlas);

struct SurfaceSample {
    Vec3f position, normal;  ///< on the mesh; shading normal, unit
};

/// A place in a cell, evenly distributed by area on the surface when u, v and w are in [0, 1).
SurfaceSample sampleCell(const Mesh& mesh, const Atlas& atlas, const TexelMap& map, std::size_t cell, double u,
                         double v, double w);

}  // namespace searchlight
