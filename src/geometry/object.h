// The object of a scene, placed: in mm, centred on its bounding box.
#pragma once

#include <string>
#include <vector>

#include "scene/mesh.h"
#include "scene/point_cloud.h"
#include "scene/scene.h"

namespace searchlight {

/// Either of the two is empty: an object is a mesh, or a point cloud. A cloud has normals and areas here: what its file
/// lacks was estimated from its neighbours.
struct Object {
    std::string name;  ///< as the scene calls it
    Mesh mesh;         ///< with a normal per vertex
    PointCloud cloud;
    double longest_mm = 0;           ///< the longest side of the bounding box
    Vec3 half_extent;                ///< of the bounding box, mm
    std::string content_hash;        ///< of the shape in mm, hexadecimal: names its caches
    std::vector<std::string> notes;  ///< what a user should know: "normals estimated", "12 open edges"

    bool isMesh() const { return !mesh.triangles.empty(); }
};

/// Loads the built-in object or file that scene.object names and scales it so that its longest side has scene.scale mm.
/// Throws what readShape throws, and an input Error for a shape without extent.
Object placeObject(const Scene& scene);

/// Ids of the objects that the program makes itself: "sphere", "slab", "torus_knot", "statue".
std::vector<std::string> builtInObjects();

/// Throws unknownName. Outward, closed, with normals and uvs; its size is of order 1. `detail` doubles the resolution
/// with each step up and halves it with each step down.
Mesh builtInObject(std::string_view id, int detail = 0);

}  // namespace searchlight
