// Where short flights meet a closed mesh. A hierarchy is descended from its root for each ray, however short; a flight
// of a few mean free paths passes few cells of a grid, and begins at the one that it is in.
#pragma once

#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "base/large_pages.h"
#include "geometry/rays.h"
#include "scene/mesh.h"
#include "transport/mesh/flights.h"

namespace searchlight {

/// The triangles of a mesh by the cells that they touch.
struct TriangleGrid {
    static constexpr std::size_t kBlock = 8;
    static constexpr std::uint32_t kLast = 0x8000'0000;

    /// Eight triangles of a cell, with their own corners: a test reads five cache lines side by side.
    struct alignas(64) Block {
        float corners[9][kBlock];         ///< x, y, z of the first corner, of the second, of the third; mm
        std::uint32_t triangles[kBlock];  ///< kLast is set in the first when the cell has no further block
    };

    /// A cell that holds triangles. What they are inside the cell lies where normal . p (mm) is at least `least`.
    struct alignas(16) Cell {
        std::uint32_t block = 0;   ///< the first
        std::uint32_t normal = 0;  ///< whole numbers x, y, z of 10 bits, from the highest
        float least = 0;
    };

    /// 4 x 4 x 4 cells: most of them are empty, and walks ask for cells all over the mesh.
    struct alignas(16) Brick {
        std::uint32_t full[2] = {};   ///< a bit per cell that holds triangles; x runs fastest
        std::uint32_t begin[2] = {};  ///< of those of each half: the first one's place in `cells`

        /// The place in `cells` of a cell that holds triangles.
        std::size_t placeOf(std::size_t cell) const {
            const std::uint32_t before = full[cell / 32] & ((std::uint32_t{1} << cell % 32) - 1);
            return begin[cell / 32] + static_cast<std::size_t>(std::popcount(before));
        }
    };

    Vec3f origin;  ///< lowest corner, mm
    float cell_mm = 0;
    std::int32_t nx = 0, ny = 0, nz = 0;           ///< cells; a multiple of 4
    std::vector<Brick, LargePages<Brick>> bricks;  ///< x runs fastest
    std::vector<Cell, LargePages<Cell>> cells;     ///< those that hold triangles, brick after brick
    std::vector<Block, LargePages<Block>> blocks;

    /// Nearest hits with t in (t_min, t_max]: as RayScene has them; a miss has t = infinity. Each flight is known to
    /// meet nothing before t_min; it may begin anywhere, inside the grid it is fast. `positions` of the hits, mm.
    /// Watertight at shared edges as RayScene is. Targets with FMA agree bit for bit.
    void intersect(std::span<const Ray> flights, std::span<RayHit> hits, std::span<Vec3> positions) const;
    /// The same for flights side by side; `lost` is left alone. What lies inside is moved inwards by so much.
    void intersect(const Flights& flights, float nudge_mm, FlightHits& hits) const;
};

/// Cells of that side, or of the longest extent's 256th part.
TriangleGrid buildTriangleGrid(const Mesh& mesh, double cell_mm);

/// A side with which flights of that mean length pass few cells, and these hold few triangles; mm.
double gridCell(const Mesh& mesh, double area_mm2, double mfp_mm);

}  // namespace searchlight
