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
    static constexpr std::size_t kVertices = 12;

    /// Up to eight triangles of a cell and their vertices, in three cache lines: what a test takes most time for is to
    /// wait for them. Places that are left over repeat the first triangle: met twice, it is still one hit.
    struct alignas(64) Block {
        float x[kVertices] = {}, y[kVertices] = {}, z[kVertices] = {};  ///< mm
        std::uint8_t corners[3][kBlock] = {};                           ///< which vertices
        std::uint8_t numbers[3][kBlock] = {};                           ///< of the triangles, lowest byte first

        Vec3f corner(std::size_t triangle, std::size_t which) const {
            const std::size_t v = corners[which][triangle];
            return {x[v], y[v], z[v]};
        }
        std::uint32_t number(std::size_t triangle) const {
            return numbers[0][triangle] | std::uint32_t{numbers[1][triangle]} << 8 |
                   std::uint32_t{numbers[2][triangle]} << 16;
        }
    };
    static constexpr std::size_t kMostTriangles = std::size_t{1} << 24;

    /// A cell that holds triangles. What they are inside the cell lies where normal . p (mm) is at least `least`.
    struct alignas(16) Cell {
        std::uint32_t block = 0;   ///< the first, and
        std::uint32_t blocks = 0;  ///< how many there are
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

/// Cells of that side, or of the longest extent's 256th part. Of up to kMostTriangles triangles.
TriangleGrid buildTriangleGrid(const Mesh& mesh, double cell_mm);

/// A side with which flights of that mean length pass few cells, and these hold few triangles; mm.
double gridCell(const Mesh& mesh, double area_mm2, double mfp_mm);

}  // namespace searchlight
