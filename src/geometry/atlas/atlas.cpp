#include "geometry/atlas/atlas.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "base/error.h"
#include "base/parallel.h"
#include "geometry/atlas/file_uvs.h"
#include "geometry/atlas/flatten.h"
#include "geometry/atlas/pack_charts.h"

namespace searchlight {

namespace {

// So many charts to begin with: a body has six sides. Two are the fewest that a closed one can have.
constexpr std::size_t first_charts = 6, fewest_charts = 2;

struct Laid {
    ChartFaces faces;
    FlatChart flat;  // one triangle per face
    bool sound = false;
    double stretch = 1;
};

std::vector<MappedTriangle> mapped(const SurfaceGraph& surface, std::span<const std::uint32_t> faces,
                                   std::span<const FlatTriangle> flat) {
    std::vector<MappedTriangle> triangles;
    for (std::size_t i = 0; i < faces.size(); ++i) {
        const auto& [a, b, c] = surface.triangles[faces[i]];
        triangles.push_back({{surface.positions[a], surface.positions[b], surface.positions[c]}, flat[i]});
    }
    return triangles;
}

// A single triangle, exactly.
FlatTriangle laidAlone(const SurfaceGraph& surface, std::uint32_t face) {
    const auto& [a, b, c] = surface.triangles[face];
    const Vec3 along = surface.positions[b] - surface.positions[a],
               across = surface.positions[c] - surface.positions[a];
    const double base = length(along);
    return {Vec2{0, 0}, Vec2{base, 0}, Vec2{dot(along, across) / base, length(cross(along, across)) / base}};
}

Laid lay(const SurfaceGraph& surface, ChartFaces faces, bool conformal) {
    Laid laid{.faces = std::move(faces)};
    if (laid.faces.size() == 1) {
        laid.flat = {laidAlone(surface, laid.faces[0])};
        laid.sound = true;
        return laid;
    }
    const ChartMesh chart(surface, laid.faces);
    const std::vector<Vec2> places = conformal ? flattenConformally(chart) : flatten(chart);
    double area = 0;
    for (const auto& [a, b, c] : chart.triangles) laid.flat.push_back({places[a], places[b], places[c]});
    for (const std::uint32_t face : laid.faces) area += surface.areas[face];
    // Turned triangles have an infinite stretch.
    laid.stretch = stretchOf(mapped(surface, laid.faces, laid.flat)).l2;
    laid.sound = std::isfinite(laid.stretch) && !overlaps(laid.flat, 1e-7 * std::sqrt(area));
    return laid;
}

std::vector<Laid> layAll(const SurfaceGraph& surface, const AtlasOptions& options, Observer& observer) {
    std::vector<std::uint32_t> all(surface.triangles.size());
    std::iota(all.begin(), all.end(), 0u);
    std::vector<ChartFaces> open = growCharts(surface, all, options.conformal ? fewest_charts : first_charts);
    mergeSmallCharts(surface, open, 8);
    std::vector<Laid> done;
    while (!open.empty()) {
        if (observer.cancelled()) throw interruptedError();
        std::vector<Laid> laid(open.size());
        std::vector<std::vector<ChartFaces>> halves(open.size());
        parallelFor(open.size(), options.threads, [&](std::size_t i) {
            laid[i] = lay(surface, std::move(open[i]), options.conformal);
            // Few triangles are not cut for their stretch: what is gained is lost in the gutters.
            const bool cut = !laid[i].sound ||
                             (!options.conformal && laid[i].stretch > options.stretch && laid[i].faces.size() > 32);
            if (cut) halves[i] = growCharts(surface, laid[i].faces, 2);
        });
        open.clear();
        for (std::size_t i = 0; i < laid.size(); ++i) {
            if (halves[i].empty())
                done.push_back(std::move(laid[i]));
            else
                for (ChartFaces& half : halves[i]) open.push_back(std::move(half));
        }
        observer.progress("atlas", done.size(), done.size() + open.size(), "charts");
    }
    return done;
}

void describe(const SurfaceGraph& surface, Atlas& atlas) {
    std::vector<std::uint32_t> faces;
    std::vector<FlatTriangle> flat;
    double area = 0;
    std::size_t charts = 0;
    for (std::uint32_t t = 0; t < atlas.triangles.size(); ++t) {
        if (atlas.charts[t] == no_triangle) continue;
        faces.push_back(t);
        flat.push_back(atlas.triangles[t]);
        area += cross(flat.back()[1] - flat.back()[0], flat.back()[2] - flat.back()[0]) / 2;
        charts = std::max<std::size_t>(charts, atlas.charts[t] + 1);
    }
    atlas.report.charts = charts;
    atlas.report.stretch = stretchOf(mapped(surface, faces, flat));
    atlas.report.fill = area / (static_cast<double>(atlas.resolution) * atlas.resolution);
}

}  // namespace

Atlas makeAtlas(const Mesh& mesh, const AtlasOptions& options, Observer& observer) {
    const auto finite = [](Vec3f p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); };
    if (!std::ranges::all_of(mesh.positions, finite))
        throw inputError("a mesh with a position that is not finite has no atlas");
    const SurfaceGraph surface(mesh);
    if (std::ranges::none_of(surface.areas, [](double area) { return area > 0; }))
        throw inputError("a mesh without area has no atlas");

    Atlas atlas{.resolution = options.resolution,
                .triangles = std::vector<FlatTriangle>(mesh.triangles.size()),
                .charts = std::vector<std::uint32_t>(mesh.triangles.size(), no_triangle)};
    if (options.uvs != AtlasUvs::own) {
        std::string fault = faultOfUvs(mesh, surface);
        if (fault.empty()) {
            atlas.charts = chartsOfUvs(mesh, surface);
            for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
                for (std::size_t k = 0; k < 3 && atlas.charts[t] != no_triangle; ++k) {
                    const Vec2f uv = mesh.uvs[mesh.triangles[t][k]];
                    const auto texels = [&](float x) { return options.resolution * std::clamp<double>(x, 0, 1); };
                    atlas.triangles[t][k] = {texels(uv.x), texels(uv.y)};
                }
            atlas.report.from_file = true;
            describe(surface, atlas);
            return atlas;
        }
        if (options.uvs == AtlasUvs::file)
            throw inputError(fmt::format("the mesh's uvs make no atlas: {}", fault), "--uvs own makes an atlas");
        if (!mesh.uvs.empty()) atlas.report.fault = std::move(fault);
    }

    const std::vector<Laid> laid = layAll(surface, options, observer);
    std::vector<FlatChart> charts;
    for (const Laid& chart : laid) charts.push_back(chart.flat);
    const Packing packing = packCharts(charts, options.resolution, options.gutter);
    for (std::size_t i = 0; i < laid.size(); ++i)
        for (std::size_t k = 0; k < laid[i].faces.size(); ++k) {
            atlas.charts[laid[i].faces[k]] = static_cast<std::uint32_t>(i);
            atlas.triangles[laid[i].faces[k]] = packing.placed[i][k];
        }
    describe(surface, atlas);
    return atlas;
}

Mesh withAtlasUvs(const Mesh& mesh, const Atlas& atlas) {
    Mesh result;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> copies;  // of a vertex, one per chart
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        auto& triangle = result.triangles.emplace_back();
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t vertex = mesh.triangles[t][k];
            const auto [found, is_new] =
                copies.try_emplace({vertex, atlas.charts[t]}, static_cast<std::uint32_t>(result.positions.size()));
            triangle[k] = found->second;
            if (!is_new) continue;
            result.positions.push_back(mesh.positions[vertex]);
            if (!mesh.normals.empty()) result.normals.push_back(mesh.normals[vertex]);
            const Vec2 at = atlas.triangles[t][k];
            result.uvs.push_back(
                {static_cast<float>(at.x / atlas.resolution), static_cast<float>(at.y / atlas.resolution)});
        }
    }
    return result;
}

}  // namespace searchlight
