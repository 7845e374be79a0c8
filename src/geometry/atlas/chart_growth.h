// A surface cut into discs of triangles that face much the same way.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/atlas/surface_graph.h"

namespace searchlight {

/// Triangles of one chart, by their numbers in the SurfaceGraph. A chart is a topological disc: connected over edges,
/// with one border that meets no vertex twice.
using ChartFaces = std::vector<std::uint32_t>;

/// Cuts `faces` into about `count` charts, and at least one per connected part: triangles join the seed that they reach
/// over the shortest way, on which turning away from the chart's mean normal counts as length ([Sander2003, sec. 4.1]),
/// and only where the chart stays a disc. Seeds move to the middles of their charts and all is grown again. Triangles
/// without area are left out. What no seed may take becomes charts of its own, so there may be more than `count`.
std::vector<ChartFaces> growCharts(const SurfaceGraph& surface, std::span<const std::uint32_t> faces,
                                   std::size_t count);

/// Charts of few triangles join the neighbour with which they share most border, where the two make a disc.
void mergeSmallCharts(const SurfaceGraph& surface, std::vector<ChartFaces>& charts, std::size_t fewest_faces);

}  // namespace searchlight
