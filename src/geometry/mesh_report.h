// What a mesh is like, before light is sent into it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scene/mesh.h"

namespace searchlight {

/// Vertices of equal positions count as one, so that seams are no holes. Lengths in the mesh's own unit.
struct MeshReport {
    std::uint64_t vertices = 0, welded_vertices = 0;  ///< as in the file; those used, by position
    std::uint64_t triangles = 0;
    std::uint64_t unreferenced_vertices = 0;  ///< used by no triangle
    std::uint64_t degenerate_triangles = 0;   ///< two corners at one position; they are in no other count below
    std::uint64_t boundary_edges = 0;         ///< with one triangle
    std::uint64_t nonmanifold_edges = 0;      ///< with three or more
    std::uint64_t misoriented_edges = 0;      ///< with two triangles that run along it the same way
    std::uint64_t components = 0;             ///< that share no vertex
    std::int64_t euler = 0;                   ///< vertices - edges + faces, welded
    bool closed = false;                      ///< every edge has two triangles, which agree on what is outside
    double volume = 0;  ///< signed: negative when it is inside out; of little meaning unless closed
    double area = 0;
    Vec3 low, high;                     ///< of the used vertices
    bool normals = false;               ///< one per vertex, each of unit length within 1 %
    bool uvs = false;                   ///< one per vertex
    std::uint64_t opposed_normals = 0;  ///< triangles whose vertex normals sum to the other side

    double longest() const;
    /// Handles, of all components together; 0 unless closed.
    std::int64_t genus() const;
};

MeshReport reportMesh(const Mesh& mesh);

/// One sentence per thing that makes a mesh less than a closed body with outward sides; empty: nothing to say.
std::vector<std::string> faultsOf(const MeshReport& report);

/// What unit the size suggests: "0.156 long: metres would make it 156 mm".
std::string unitsHint(const MeshReport& report);

}  // namespace searchlight
