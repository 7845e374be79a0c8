#include "geometry/object.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "geometry/cloud_estimate.h"
#include "geometry/cloud_surface.h"
#include "geometry/content_hash.h"
#include "geometry/mesh_report.h"
#include "geometry/objects/objects.h"
#include "geometry/vertex_normals.h"
#include "io/shape_file.h"

namespace searchlight {

namespace {

struct BuiltIn {
    const char* id;
    Mesh (*make)(double resolution);
};

constexpr BuiltIn built_ins[] = {
    {"sphere", sphereObject}, {"slab", slabObject}, {"torus_knot", torusKnotObject}, {"statue", statueObject}};

bool isBuiltIn(std::string_view name) {
    return std::ranges::any_of(built_ins, [&](const BuiltIn& built_in) { return name == built_in.id; });
}

// Positions become mm about the centre of their bounding box.
void place(std::vector<Vec3f>& positions, const Scene& scene, Object& object) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Vec3 low{infinity, infinity, infinity}, high{-infinity, -infinity, -infinity};
    for (const Vec3f p : positions) {
        low = {std::min<double>(low.x, p.x), std::min<double>(low.y, p.y), std::min<double>(low.z, p.z)};
        high = {std::max<double>(high.x, p.x), std::max<double>(high.y, p.y), std::max<double>(high.z, p.z)};
    }
    const Vec3 size = high - low, centre = 0.5 * (low + high);
    const double longest = std::max({size.x, size.y, size.z});
    if (positions.empty() || !(longest > 0) || !std::isfinite(longest))
        throw inputError("the object has no extent, so it cannot be scaled", "a mesh or at least two different points")
            .at(scene.object);
    const double scale = scene.scale / longest;
    for (Vec3f& p : positions) p = toFloat(scale * (toDouble(p) - centre));
    object.longest_mm = scene.scale;
    object.scale = scale;
    object.half_extent = (0.5 * scale) * size;
}

void dropUnreferenced(Mesh& mesh, std::vector<std::string>& notes) {
    constexpr std::uint32_t none = ~std::uint32_t{0};
    std::vector<std::uint32_t> renumbered(mesh.positions.size(), none);
    for (const auto& triangle : mesh.triangles)
        for (const std::uint32_t corner : triangle) renumbered[corner] = 0;
    std::uint32_t count = 0;
    for (std::size_t i = 0; i < renumbered.size(); ++i) {
        if (renumbered[i] == none) continue;
        mesh.positions[count] = mesh.positions[i];
        if (!mesh.normals.empty()) mesh.normals[count] = mesh.normals[i];
        if (!mesh.uvs.empty()) mesh.uvs[count] = mesh.uvs[i];
        renumbered[i] = count++;
    }
    if (count == mesh.positions.size()) return;
    notes.push_back(fmt::format("{} vertices that no triangle uses are left out", mesh.positions.size() - count));
    mesh.positions.resize(count);
    if (!mesh.normals.empty()) mesh.normals.resize(count);
    if (!mesh.uvs.empty()) mesh.uvs.resize(count);
    for (auto& triangle : mesh.triangles)
        for (std::uint32_t& corner : triangle) corner = renumbered[corner];
}

// A vertex without a normal of its own gets the mean of its triangles.
void completeNormals(Mesh& mesh, std::vector<std::string>& notes) {
    if (mesh.normals.size() != mesh.positions.size()) {
        mesh.normals = vertexNormals(mesh);
        notes.emplace_back("normals are the means over the triangles around each vertex");
        return;
    }
    const auto unknown = [](Vec3f n) { return !(length(toDouble(n)) > 0.5); };
    if (std::ranges::none_of(mesh.normals, unknown)) return;
    const std::vector<Vec3f> means = vertexNormals(mesh);
    for (std::size_t i = 0; i < means.size(); ++i)
        if (unknown(mesh.normals[i])) mesh.normals[i] = means[i];
}

void turnInsideOut(Mesh& mesh) {
    for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
    for (Vec3f& n : mesh.normals) n = {-n.x, -n.y, -n.z};
}

void placeMesh(Mesh mesh, const Scene& scene, Object& object) {
    dropUnreferenced(mesh, object.notes);
    place(mesh.positions, scene, object);
    const MeshReport report = reportMesh(mesh);
    for (const std::string& fault : faultsOf(report)) object.notes.push_back(fault);
    if (report.closed && report.volume < 0) {
        turnInsideOut(mesh);
        object.notes.emplace_back("so the mesh was turned inside out");
    }
    completeNormals(mesh, object.notes);
    object.content_hash = contentHash(mesh);
    object.mesh = std::move(mesh);
}

void placeCloud(PointCloud cloud, const Scene& scene, Object& object) {
    const std::size_t count = cloud.positions.size();
    place(cloud.positions, scene, object);
    const double scale = object.scale;
    for (float& area : cloud.areas) area = static_cast<float>(area * scale * scale);
    const auto unknown = [](Vec3f n) { return !(length(toDouble(n)) > 0.5); };
    if (cloud.normals.size() != count || std::ranges::any_of(cloud.normals, unknown)) {
        cloud.normals = estimateNormals(cloud.positions);
        object.notes.emplace_back("normals are estimated from neighbouring points");
    }
    if (cloud.areas.size() != count || std::ranges::any_of(cloud.areas, [](float a) { return !(a > 0); })) {
        cloud.areas = estimateAreas(cloud.positions);
        object.notes.emplace_back("areas are estimated from the distances to neighbouring points");
    }
    object.content_hash = contentHash(cloud);
    object.mesh = surfaceThrough(cloud);
    if (object.mesh.triangles.empty())
        throw inputError(fmt::format("no surface runs through the {} points", count), "more points, or a mesh")
            .at(scene.object);
    for (const std::string& fault : faultsOf(reportMesh(object.mesh)))
        object.notes.push_back("of the surface through the points, " + fault);
    object.notes.push_back(
        fmt::format("what is seen is a surface of {} triangles through the points", object.mesh.triangles.size()));
    object.cloud = std::move(cloud);
}

}  // namespace

std::vector<std::string> builtInObjects() {
    std::vector<std::string> ids;
    for (const BuiltIn& built_in : built_ins) ids.emplace_back(built_in.id);
    return ids;
}

Mesh builtInObject(std::string_view id, int detail) {
    for (const BuiltIn& built_in : built_ins)
        if (id == built_in.id) return built_in.make(std::exp2(std::clamp(detail, -4, 3)));
    throw unknownName(ErrorKind::input, "object", id, builtInObjects());
}

Mesh meshNamed(const std::string& name) { return isBuiltIn(name) ? builtInObject(name) : readMesh(name); }

Object placeObject(const Scene& scene) {
    Object object;
    object.name = scene.object;
    Shape shape = isBuiltIn(scene.object) ? Shape(builtInObject(scene.object)) : readShape(scene.object);
    if (auto* mesh = std::get_if<Mesh>(&shape))
        placeMesh(std::move(*mesh), scene, object);
    else
        placeCloud(std::move(std::get<PointCloud>(shape)), scene, object);
    return object;
}

}  // namespace searchlight
