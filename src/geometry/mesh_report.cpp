#include "geometry/mesh_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/text.h"
#include "geometry/edges.h"
#include "geometry/vertex_normals.h"

namespace searchlight {

namespace {

class Groups {
public:
    explicit Groups(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0u); }
    std::uint32_t find(std::uint32_t i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    void join(std::uint32_t a, std::uint32_t b) { parent_[find(a)] = find(b); }

private:
    std::vector<std::uint32_t> parent_;
};

// Edges and what they connect. Returns their number.
std::uint64_t countEdges(const std::vector<HalfEdge>& edges, Groups& groups, MeshReport& report) {
    std::uint64_t count = 0;
    for (std::size_t i = 0, end = 0; i < edges.size(); i = end, ++count) {
        end = i + 1;
        while (end < edges.size() && edges[end].low == edges[i].low && edges[end].high == edges[i].high) ++end;
        groups.join(edges[i].low, edges[i].high);
        if (end - i == 1) ++report.boundary_edges;
        if (end - i > 2) ++report.nonmanifold_edges;
        if (end - i == 2 && edges[i].ascending == edges[i + 1].ascending) ++report.misoriented_edges;
    }
    return count;
}

void measure(const Mesh& mesh, MeshReport& report) {
    // About the middle of the box: far from the origin the terms of the volume cancel badly.
    const Vec3 middle = 0.5 * (report.low + report.high);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const Vec3 normal = triangleNormal(mesh, t);
        report.area += length(normal) / 2;
        report.volume += dot(normal, toDouble(mesh.positions[mesh.triangles[t][0]]) - middle) / 6;
        if (!report.normals) continue;
        Vec3 sum;
        for (const std::uint32_t corner : mesh.triangles[t]) sum = sum + toDouble(mesh.normals[corner]);
        if (dot(sum, normal) < 0) ++report.opposed_normals;
    }
}

}  // namespace

double MeshReport::longest() const { return std::max({high.x - low.x, high.y - low.y, high.z - low.z}); }

std::int64_t MeshReport::genus() const { return closed ? static_cast<std::int64_t>(components) - euler / 2 : 0; }

MeshReport reportMesh(const Mesh& mesh) {
    MeshReport report;
    report.vertices = mesh.positions.size();
    report.triangles = mesh.triangles.size();
    report.uvs = !mesh.uvs.empty() && mesh.uvs.size() == mesh.positions.size();
    report.normals =
        !mesh.normals.empty() && mesh.normals.size() == mesh.positions.size() &&
        std::ranges::all_of(mesh.normals, [](Vec3f n) { return std::abs(length(toDouble(n)) - 1) < 0.01; });

    const Weld weld = weldPositions(mesh.positions);
    std::vector<std::uint8_t> used(mesh.positions.size()), used_welded(weld.count);
    for (const auto& triangle : mesh.triangles)
        for (const std::uint32_t corner : triangle) used[corner] = used_welded[weld.of[corner]] = 1;
    report.unreferenced_vertices = static_cast<std::uint64_t>(std::ranges::count(used, 0));
    report.welded_vertices = static_cast<std::uint64_t>(std::ranges::count(used_welded, 1));

    constexpr double infinity = std::numeric_limits<double>::infinity();
    Vec3 low{infinity, infinity, infinity}, high{-infinity, -infinity, -infinity};
    for (std::size_t i = 0; i < used.size(); ++i) {
        if (!used[i]) continue;
        const Vec3 p = toDouble(mesh.positions[i]);
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    if (!mesh.triangles.empty()) report.low = low, report.high = high;

    const std::vector<HalfEdge> edges = halfEdges(mesh, weld);
    report.degenerate_triangles = report.triangles - edges.size() / 3;
    Groups groups(weld.count);
    const std::uint64_t edge_count = countEdges(edges, groups, report);
    std::vector<std::uint8_t> is_root(weld.count);
    for (const HalfEdge& edge : edges) is_root[groups.find(edge.low)] = 1;
    report.components = static_cast<std::uint64_t>(std::ranges::count(is_root, 1));
    report.euler =
        static_cast<std::int64_t>(report.welded_vertices + edges.size() / 3) - static_cast<std::int64_t>(edge_count);
    report.closed = !edges.empty() && report.boundary_edges + report.nonmanifold_edges + report.misoriented_edges == 0;
    measure(mesh, report);
    return report;
}

std::vector<std::string> faultsOf(const MeshReport& report) {
    std::vector<std::string> faults;
    const auto state = [&](std::uint64_t count, std::string_view one, std::string_view many) {
        if (count > 0) faults.push_back(fmt::format("{} {}", count, count == 1 ? one : many));
    };
    state(report.boundary_edges, "edge is open", "edges are open");
    state(report.nonmanifold_edges, "edge has more than two triangles", "edges have more than two triangles");
    state(report.misoriented_edges, "edge has triangles that disagree on what is outside",
          "edges have triangles that disagree on what is outside");
    state(report.degenerate_triangles, "triangle has no area", "triangles have no area");
    state(report.unreferenced_vertices, "vertex belongs to no triangle", "vertices belong to no triangle");
    if (report.closed && report.volume < 0) faults.emplace_back("the sides face inward");
    if (report.closed)
        state(report.opposed_normals, "triangle faces against its normals", "triangles face against their normals");
    return faults;
}

std::string unitsHint(const MeshReport& report) {
    const double longest = report.longest();
    if (!(longest > 0)) return "no extent";
    const auto as = [&](std::string_view unit, double mm) {
        return fmt::format("{} long: {} would make it {} mm", prettyNumber(longest), unit, prettyNumber(longest * mm));
    };
    if (longest < 0.5) return as("metres", 1000);
    if (longest <= 3)
        return fmt::format("{} long: a size without a unit, so --scale has to say it", prettyNumber(longest));
    if (longest <= 30) return as("centimetres", 10);
    return as("millimetres", 1);
}

}  // namespace searchlight
