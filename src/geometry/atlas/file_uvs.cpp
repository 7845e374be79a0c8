#include "geometry/atlas/file_uvs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "geometry/atlas/overlap.h"

namespace searchlight {

namespace {

// Of the unit square: what exporters round away.
constexpr double rounding = 1e-6;

FlatTriangle uvTriangle(const Mesh& mesh, std::size_t t) {
    FlatTriangle flat;
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec2f uv = mesh.uvs[mesh.triangles[t][k]];
        flat[k] = {uv.x, uv.y};
    }
    return flat;
}

// Corner of `face` at the welded vertex; 3 where it has none.
std::size_t cornerAt(const SurfaceGraph& surface, std::uint32_t face, std::uint32_t vertex) {
    std::size_t k = 0;
    while (k < 3 && surface.triangles[face][k] != vertex) ++k;
    return k;
}

}  // namespace

std::string faultOfUvs(const Mesh& mesh, const SurfaceGraph& surface) {
    if (mesh.uvs.empty() || mesh.uvs.size() != mesh.positions.size()) return "there are none";
    std::size_t outside = 0, degenerate = 0, turned = 0, count = 0;
    std::vector<FlatTriangle> flats;
    std::vector<std::uint32_t> faces;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        if (!(surface.areas[t] > 0)) continue;
        const FlatTriangle flat = uvTriangle(mesh, t);
        ++count;
        const auto inside = [](double x) { return x >= -rounding && x <= 1 + rounding; };  // false for NaN
        if (!std::ranges::all_of(flat, [&](Vec2 p) { return inside(p.x) && inside(p.y); })) {
            ++outside;
            continue;
        }
        const double area = cross(flat[1] - flat[0], flat[2] - flat[0]);
        if (std::abs(area) < 1e-14)
            ++degenerate;
        else if (area < 0)
            ++turned;
        flats.push_back(flat);
        faces.push_back(t);
    }
    if (count == 0) return "no triangle has an area";
    if (outside > 0) return fmt::format("{} of {} triangles lie outside the unit square", outside, count);
    if (degenerate > 0) return fmt::format("{} of {} triangles have no area there", degenerate, count);
    if (turned == count) return "all triangles lie inside out";
    if (turned > 0) return fmt::format("{} of {} triangles are turned over", turned, count);
    if (const auto pair = overlaps(flats, rounding))
        return fmt::format("triangles {} and {} lie over one another", faces[pair->first], faces[pair->second]);
    return {};
}

std::vector<std::uint32_t> chartsOfUvs(const Mesh& mesh, const SurfaceGraph& surface) {
    std::vector<std::uint32_t> charts(mesh.triangles.size(), no_triangle), open;
    const auto joined = [&](std::uint32_t face, std::size_t side, std::uint32_t other) {
        for (const std::size_t k : {side, (side + 1) % 3}) {
            const std::size_t there = cornerAt(surface, other, surface.triangles[face][k]);
            if (there == 3 || !(mesh.uvs[mesh.triangles[face][k]] == mesh.uvs[mesh.triangles[other][there]]))
                return false;
        }
        return true;
    };
    std::uint32_t count = 0;
    for (std::uint32_t first = 0; first < charts.size(); ++first) {
        if (charts[first] != no_triangle || !(surface.areas[first] > 0)) continue;
        charts[first] = count;
        open.assign(1, first);
        while (!open.empty()) {
            const std::uint32_t face = open.back();
            open.pop_back();
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint32_t other = surface.neighbours[face][k];
                if (other == no_triangle || charts[other] != no_triangle || !(surface.areas[other] > 0) ||
                    !joined(face, k, other))
                    continue;
                charts[other] = count;
                open.push_back(other);
            }
        }
        ++count;
    }
    return charts;
}

}  // namespace searchlight
