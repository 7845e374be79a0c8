// Meshes and point clouds from anywhere: read or refused with a place; what was read keeps its promises and survives
// being written. The first byte selects the format, and its highest bit means packed; or every input is of one format
// (one_format.h).
#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "base/error.h"
#include "io/shape_file.h"
#include "io/shape_formats.h"
#include "one_format.h"

namespace {

using namespace searchlight;

void expect(bool holds) {
    if (!holds) std::abort();
}

void checkNormals(const std::vector<Vec3f>& normals, std::size_t count, bool zeros) {
    expect(normals.empty() || normals.size() == count);
    for (const Vec3f normal : normals)
        expect(std::abs(length(toDouble(normal)) - 1) < 1e-5 || (zeros && normal == Vec3f{}));
}

void check(const Mesh& mesh) {
    expect(!mesh.positions.empty() && !mesh.triangles.empty());
    for (const Vec3f position : mesh.positions) expect(isFinite(position));
    for (const std::array<std::uint32_t, 3>& triangle : mesh.triangles)
        for (const std::uint32_t vertex : triangle) expect(vertex < mesh.positions.size());
    checkNormals(mesh.normals, mesh.positions.size(), false);
    expect(mesh.uvs.empty() || mesh.uvs.size() == mesh.positions.size());
    for (const std::string& bytes : {objBytes(mesh), plyBytes(mesh)}) {
        const Mesh again = std::get<Mesh>(parseShape(bytes, bytes.starts_with("ply") ? "a.ply" : "a.obj"));
        expect(again.positions == mesh.positions && again.triangles == mesh.triangles);
        // In OBJ only faces say which normal a vertex has, so those that no triangle uses lose theirs.
        for (const std::array<std::uint32_t, 3>& triangle : mesh.triangles)
            for (const std::uint32_t vertex : triangle) {
                expect(mesh.uvs.empty() || again.uvs[vertex] == mesh.uvs[vertex]);
                expect(mesh.normals.empty() || again.normals[vertex] == mesh.normals[vertex]);
            }
    }
}

void check(const PointCloud& cloud) {
    expect(!cloud.positions.empty());
    for (const Vec3f position : cloud.positions) expect(isFinite(position));
    checkNormals(cloud.normals, cloud.positions.size(), true);
    expect(cloud.areas.empty() || cloud.areas.size() == cloud.positions.size());
    for (const float area : cloud.areas) expect(std::isfinite(area) && area >= 0);
    for (const std::string& bytes : {ptcBytes(cloud), plyBytes(cloud)}) {
        const PointCloud again = std::get<PointCloud>(parseShape(bytes, bytes.starts_with("ply") ? "a.ply" : "a.ptc"));
        expect(again.positions == cloud.positions && again.areas == cloud.areas);
        expect(again.normals.size() == cloud.normals.size());
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const std::vector<std::string> endings = shapeEndings();
    static const std::string only = oneFormat(endings);
    std::string_view bytes(reinterpret_cast<const char*>(data), size);
    std::string path = "no_such_folder/fuzz" + only;
    if (only.empty()) {
        if (bytes.empty()) return 0;
        path += endings[(data[0] & 0x7F) % endings.size()];
        if (data[0] & 0x80) path += ".gz";
        bytes.remove_prefix(1);
    }
    try {
        const Shape shape = parseShape(bytes, path);
        std::visit([](const auto& kind) { check(kind); }, shape);
    } catch (const Error& error) {
        expect(error.kind == ErrorKind::input && error.file == path);
    }
    return 0;
}
