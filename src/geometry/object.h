// The object of a scene, placed: in mm, centred on its bounding box.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scene/mesh.h"
#include "scene/point_cloud.h"
#include "scene/scene.h"

namespace searchlight {

/// A mesh, or a point cloud and the mesh of a surface through it, so that there is always something to trace. A cloud
/// has normals and areas here: what its file lacks was estimated from its neighbours.
struct Object {
    std::string name;                ///< as the scene calls it
    Mesh mesh;                       ///< with a normal per vertex
    PointCloud cloud;                ///< empty where the object is a mesh of its own
    double longest_mm = 0;           ///< the longest side of the bounding box
    double scale = 1;                ///< mm per unit of the file
    Vec3 half_extent;                ///< of the bounding box, mm
    std::string content_hash;        ///< of the shape in mm, hexadecimal: names its caches
    std::vector<std::string> notes;  ///< what a user should know: "normals estimated", "12 open edges"

    bool isMesh() const { return cloud.positions.empty(); }
};

/// Loads the built-in object or file that scene.object names and scales it so that its longest side has scene.scale mm.
/// Throws what readShape throws, and an input Error for a shape without extent.
/// Vertices that no triangle uses are left out; a closed mesh that is inside out is turned.
Object placeObject(const Scene& scene);

/// Ids of the objects that the program makes itself: "sphere", "slab", "torus_knot", "statue".
std::vector<std::string> builtInObjects();

/// Throws unknownName. Outward, closed, with normals and uvs; its size is of order 1. `detail` doubles the resolution
/// with each step up and halves it with each step down.
Mesh builtInObject(std::string_view id, int detail = 0);

/// The built-in object or the mesh file of that name, as it is. Throws what readMesh throws.
Mesh meshNamed(const std::string& name);

}  // namespace searchlight
