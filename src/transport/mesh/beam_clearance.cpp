// Where a beam needs no ray: light that goes straight through the body can leave it through facets alone that face
// away from the light, and light outside can be stopped by such facets alone. Most beams have none in their way.
#include <algorithm>
#include <limits>

#include "transport/mesh/facet_beams.h"
#include "transport/mesh/facet_geometry.h"

namespace searchlight {

namespace {

// Cells of the grid that shadows of discs are looked up in: more take time, fewer find less.
constexpr double kCellsOutside = 40;
// References that lists of facets may take: 256 MiB, beyond which rays are asked.
constexpr double kMostFacets = 1 << 26;
// Above it a facet surely faces away from the light, or towards it: rounding.
constexpr double kFaces = 1e-6;

// At least the largest of direction . normal for both in boxes.
double mostAlong(const Box& directions, const Box& normals) {
    const auto most = [](double a, double b, double c, double d) { return std::max({a * c, a * d, b * c, b * d}); };
    const auto& [d0, d1] = directions;
    const auto& [n0, n1] = normals;
    return most(d0.x, d1.x, n0.x, n1.x) + most(d0.y, d1.y, n0.y, n1.y) + most(d0.z, d1.z, n0.z, n1.z);
}

Box boxOf(const Mesh& mesh, std::uint32_t triangle) {
    const auto corners = cornersOf(mesh, triangle);
    Box box{corners[0], corners[0]};
    for (const Vec3& corner : corners) box.hold(corner);
    return box;
}

}  // namespace

void FacetBeams::findClear(std::span<const Sweep> sweeps) {
    const Mesh& mesh = body_.mesh();
    const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
    const auto sweep = [&](std::uint32_t facet) { return Sweep{boxOf(mesh, facet), {}, 0}; };
    std::vector<std::optional<Box>> normals(cells_.count());  // of what each cell holds
    for (std::uint32_t facet = 0; facet < count; ++facet)
        cells_.forEach(sweep(facet), [&](std::size_t cell, double) {
            if (!normals[cell]) normals[cell] = Box{normals_[facet], normals_[facet]};
            normals[cell]->hold(normals_[facet]);
        });
    clearances_.resize(beams_.size());
    for (std::size_t i = 0; i < beams_.size(); ++i)
        clearances_[i].inside_mm = static_cast<float>(cells_.clear(sweeps[i], [&](std::size_t cell) {
            return normals[cell] && mostAlong(sweeps[i].directions, *normals[cell]) > -kFaces;
        }));

    const BeamCells outside(mesh, kCellsOutside);
    const auto of = CellLists::of(outside, 0, count, sweep, kMostFacets);
    if (!of) return;
    for (std::uint32_t light = 0; light < lights_.count(); ++light) {
        const std::optional<Box> towards = directionsTo(light);
        if (!towards) continue;
        const Box back{-1.0 * towards->high, -1.0 * towards->low};
        std::vector<char> stops(outside.count()), open(outside.count());
        for (std::size_t cell = 0; cell < stops.size(); ++cell)
            stops[cell] = std::ranges::any_of(of->at(cell), [&](std::uint32_t facet) {
                return mostAlong(back, {normals_[facet], normals_[facet]}) > -kFaces;
            });
        const auto stopped = [&](std::size_t cell) { return stops[cell] != 0; };
        for (std::size_t cell = 0; cell < open.size(); ++cell)
            if (!of->at(cell).empty())
                open[cell] = outside.clear({outside.boxOf(cell), *towards, std::numeric_limits<double>::infinity()},
                                           stopped) == std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < beams_.size(); ++i) {
            if (beams_[i].light != light) continue;
            bool& clear = clearances_[i].outside;
            clear = true;
            outside.forEach(sweep(beams_[i].triangle),
                            [&](std::size_t cell, double) { clear = clear && open[cell] != 0; });
        }
    }
}

}  // namespace searchlight
