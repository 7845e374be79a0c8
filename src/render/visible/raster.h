// The triangles of a mesh, drawn into tiles on the CPU.
#pragma once

#include <utility>

#include "render/view.h"
#include "render/visible/tile_hits.h"

namespace searchlight {

/// A triangle in a tile, and the pixels of the tile's window that its bounding box touches, both ends included. The
/// upper bit of an end is set where the box does not reach the centres of that column or row.
struct BinnedTriangle {
    std::uint32_t triangle;
    std::uint8_t left, right, top, bottom;
};

/// Edge functions of homogeneous coordinates [Olano1997], which need no clipping: those of a ray (x, y, 1) are its
/// barycentrics times a common factor. They are exact negatives on both sides of an edge, so that no ray passes between
/// two triangles. Set up in double; a tile is drawn in float about its own corner.
class Raster final : public HitSource {
public:
    /// Projects and bins a mesh, which with the view stays alive while hits are asked for. Keeps its memory from one
    /// picture to the next.
    void draw(const View& view, const Mesh& mesh, const TraceOptions& options);

    bool centres(const Tile& tile, Hits& hits) const override;
    void samples(const Tile& tile, std::span<const std::uint16_t> pixels, std::size_t stride,
                 Hits& hits) const override;

    /// What all tiles read.
    struct Drawing {
        const View* view = nullptr;
        const Mesh* mesh = nullptr;
        double scale = 1;               ///< of `corners` against mm: keeps floats in range
        std::vector<double> corners;    ///< per vertex x, y, w and nothing: (x / w, y / w) is its place in pixels
        std::vector<float> x, y;        ///< the same place; `behind` where w is not above 0
        std::vector<float> pattern[2];  ///< x and y of the edge pattern, the last one repeated
        int columns = 0, rows = 0;      ///< of tiles
        /// Triangles in runs, each with its list per tile: the order is the same on any number of threads.
        std::vector<std::vector<std::vector<BinnedTriangle>>> bins;
    };
    static constexpr float behind = 1e30f;
    static constexpr std::uint8_t beside_centre = 0x80;

private:
    std::size_t tileIndex(const Tile& tile) const;

    Drawing drawing_;
};

}  // namespace searchlight
