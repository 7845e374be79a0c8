#include "geometry/box_charts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "geometry/edges.h"
#include "geometry/vertex_normals.h"

namespace searchlight {

namespace {

using Neighbours = std::vector<std::array<std::uint32_t, 3>>;

// Sides of the box: +x, -x, +y, -y, +z, -z.
double along(Vec3 v, int side) {
    const double x = side < 2 ? v.x : side < 4 ? v.y : v.z;
    return side % 2 == 0 ? x : -x;
}

// u x v points out of the side.
Vec2f project(Vec3f p, int side) {
    switch (side) {
        case 0: return {-p.z, p.y};
        case 1: return {p.z, p.y};
        case 2: return {p.x, -p.z};
        case 3: return {p.x, p.z};
        case 4: return {p.x, p.y};
        default: return {-p.x, p.y};
    }
}

std::vector<int> sidesOf(const std::vector<Vec3>& normals) {
    std::vector<int> sides(normals.size());
    for (std::size_t t = 0; t < sides.size(); ++t)
        for (int side = 1; side < 6; ++side)
            if (along(normals[t], side) > along(normals[t], sides[t])) sides[t] = side;
    return sides;
}

// Numbers the connected groups of triangles of one side.
std::vector<std::uint32_t> groupsOf(const std::vector<int>& sides, const Neighbours& neighbours, std::uint32_t& count) {
    std::vector<std::uint32_t> groups(sides.size(), no_triangle), open;
    count = 0;
    for (std::uint32_t first = 0; first < sides.size(); ++first) {
        if (groups[first] != no_triangle) continue;
        open.assign(1, first);
        groups[first] = count;
        while (!open.empty()) {
            const std::uint32_t t = open.back();
            open.pop_back();
            for (const std::uint32_t next : neighbours[t])
                if (next != no_triangle && groups[next] == no_triangle && sides[next] == sides[t]) {
                    groups[next] = count;
                    open.push_back(next);
                }
        }
        ++count;
    }
    return groups;
}

// A small group joins the side next door that its triangles face best, unless one of them looks away from it.
void mergeSmall(std::vector<int>& sides, const std::vector<Vec3>& normals, const Neighbours& neighbours) {
    std::uint32_t count = 0;
    const std::vector<std::uint32_t> groups = groupsOf(sides, neighbours, count);
    std::vector<std::size_t> sizes(count);
    for (const std::uint32_t group : groups) ++sizes[group];
    // Cosine below which a triangle would be squeezed to nothing.
    constexpr double least = 0.15;
    std::vector<std::array<double, 6>> worst(count), beside(count);
    for (std::uint32_t g = 0; g < count; ++g) worst[g].fill(1), beside[g].fill(0);
    for (std::uint32_t t = 0; t < sides.size(); ++t) {
        const double size = length(normals[t]);
        for (int side = 0; side < 6; ++side)
            if (size > 0) worst[groups[t]][side] = std::min(worst[groups[t]][side], along(normals[t], side) / size);
        for (const std::uint32_t next : neighbours[t])
            if (next != no_triangle && groups[next] != groups[t]) beside[groups[t]][sides[next]] += 1;
    }
    const std::size_t small = std::max<std::size_t>(8, sides.size() / 300);
    for (std::uint32_t t = 0; t < sides.size(); ++t) {
        const std::uint32_t g = groups[t];
        if (sizes[g] >= small) continue;
        int best = -1;
        for (int side = 0; side < 6; ++side)
            if (beside[g][side] > 0 && worst[g][side] > least && (best < 0 || beside[g][side] > beside[g][best]))
                best = side;
        if (best >= 0) sides[t] = best;
    }
}

struct Chart {
    int side = 0;
    Vec2f low, high;      // of the projection
    double x = 0, y = 0;  // where it lies, in the units of the mesh
    double width() const { return double(high.x) - low.x; }
    double height() const { return double(high.y) - low.y; }
};

// Rows of charts, tall ones first. Returns the side of the square that holds them.
double pack(std::vector<Chart>& charts, double gap) {
    double area = 0, widest = 0;
    for (const Chart& chart : charts) {
        area += (chart.width() + gap) * (chart.height() + gap);
        widest = std::max(widest, chart.width() + gap);
    }
    std::vector<std::size_t> order(charts.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order,
                             [&](std::size_t a, std::size_t b) { return charts[a].height() > charts[b].height(); });
    for (double size = std::max(widest, std::sqrt(area)) + gap;; size *= 1.03) {
        double x = gap, y = gap, row = 0;
        for (const std::size_t i : order) {
            if (x + charts[i].width() + gap > size) x = gap, y += row + gap, row = 0;
            charts[i].x = x, charts[i].y = y;
            x += charts[i].width() + gap;
            row = std::max(row, charts[i].height());
        }
        if (y + row + gap <= size) return size;
    }
}

}  // namespace

Mesh boxCharts(const Mesh& mesh) {
    if (mesh.triangles.empty()) return mesh;
    const Neighbours neighbours = triangleNeighbours(mesh);
    std::vector<Vec3> normals(mesh.triangles.size());
    for (std::size_t t = 0; t < normals.size(); ++t) normals[t] = triangleNormal(mesh, t);
    std::vector<int> sides = sidesOf(normals);
    for (int round = 0; round < 3; ++round) mergeSmall(sides, normals, neighbours);
    std::uint32_t count = 0;
    const std::vector<std::uint32_t> groups = groupsOf(sides, neighbours, count);

    constexpr float infinity = std::numeric_limits<float>::infinity();
    std::vector<Chart> charts(count, {0, {infinity, infinity}, {-infinity, -infinity}});
    double longest = 0;
    for (std::size_t t = 0; t < groups.size(); ++t) {
        Chart& chart = charts[groups[t]];
        chart.side = sides[t];
        for (const std::uint32_t corner : mesh.triangles[t]) {
            const Vec2f p = project(mesh.positions[corner], chart.side);
            chart.low = {std::min(chart.low.x, p.x), std::min(chart.low.y, p.y)};
            chart.high = {std::max(chart.high.x, p.x), std::max(chart.high.y, p.y)};
        }
        longest = std::max({longest, chart.width(), chart.height()});
    }
    // Room for the filter of a small map.
    const double size = pack(charts, longest / 200);

    Mesh result;
    result.triangles.resize(mesh.triangles.size());
    // Vertices of a triangle's group; the next copy of the same vertex follows in a list.
    std::vector<std::uint32_t> newest(mesh.positions.size(), no_triangle), older, group_of;
    for (std::size_t t = 0; t < groups.size(); ++t)
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t corner = mesh.triangles[t][k];
            std::uint32_t copy = newest[corner];
            while (copy != no_triangle && group_of[copy] != groups[t]) copy = older[copy];
            if (copy == no_triangle) {
                copy = static_cast<std::uint32_t>(result.positions.size());
                older.push_back(newest[corner]);
                newest[corner] = copy;
                group_of.push_back(groups[t]);
                result.positions.push_back(mesh.positions[corner]);
                if (!mesh.normals.empty()) result.normals.push_back(mesh.normals[corner]);
                const Chart& chart = charts[groups[t]];
                const Vec2f p = project(mesh.positions[corner], chart.side);
                result.uvs.push_back({static_cast<float>((chart.x + p.x - chart.low.x) / size),
                                      static_cast<float>((chart.y + p.y - chart.low.y) / size)});
            }
            result.triangles[t][k] = copy;
        }
    return result;
}

}  // namespace searchlight
