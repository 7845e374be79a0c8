#include "geometry/edges.h"

#include <algorithm>
#include <tuple>

namespace searchlight {

std::vector<HalfEdge> halfEdges(const Mesh& mesh, const Weld& weld) {
    std::vector<HalfEdge> edges;
    edges.reserve(3 * mesh.triangles.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        std::uint32_t corner[3];
        for (int k = 0; k < 3; ++k) corner[k] = weld.of[mesh.triangles[t][k]];
        if (corner[0] == corner[1] || corner[1] == corner[2] || corner[2] == corner[0]) continue;
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t a = corner[k], b = corner[(k + 1) % 3];
            edges.push_back(
                {std::min(a, b), std::max(a, b), static_cast<std::uint32_t>(t), static_cast<std::uint8_t>(k), a < b});
        }
    }
    // Bucketed by the lower vertex, of which each has few: faster than one sort by far.
    std::vector<std::uint32_t> starts(weld.count + 1);
    for (const HalfEdge& edge : edges) ++starts[edge.low + 1];
    for (std::size_t i = 1; i < starts.size(); ++i) starts[i] += starts[i - 1];
    std::vector<HalfEdge> sorted(edges.size());
    std::vector<std::uint32_t> next(starts.begin(), starts.end() - 1);
    for (const HalfEdge& edge : edges) sorted[next[edge.low]++] = edge;
    for (std::uint32_t v = 0; v < weld.count; ++v)
        std::sort(sorted.begin() + starts[v], sorted.begin() + starts[v + 1], [](const HalfEdge& a, const HalfEdge& b) {
            return std::tie(a.high, a.triangle) < std::tie(b.high, b.triangle);
        });
    return sorted;
}

std::vector<std::array<std::uint32_t, 3>> triangleNeighbours(const Mesh& mesh) {
    const std::vector<HalfEdge> edges = halfEdges(mesh, weldPositions(mesh.positions));
    std::vector<std::array<std::uint32_t, 3>> neighbours(mesh.triangles.size(),
                                                         {no_triangle, no_triangle, no_triangle});
    for (std::size_t i = 0, end = 0; i < edges.size(); i = end) {
        for (end = i + 1; end < edges.size() && edges[end].low == edges[i].low && edges[end].high == edges[i].high;)
            ++end;
        if (end - i != 2 || edges[i].ascending == edges[i + 1].ascending) continue;
        neighbours[edges[i].triangle][edges[i].side] = edges[i + 1].triangle;
        neighbours[edges[i + 1].triangle][edges[i + 1].side] = edges[i].triangle;
    }
    return neighbours;
}

}  // namespace searchlight
