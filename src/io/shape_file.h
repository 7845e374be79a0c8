// Meshes and point clouds from files, and into them. One file per format beside this one, a table in shape_file.cpp.
#pragma once

#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "scene/mesh.h"
#include "scene/point_cloud.h"

namespace searchlight {

using Shape = std::variant<Mesh, PointCloud>;

/// Reads a file by its ending (OBJ, PLY, glTF and GLB, OFF, STL; PTC, PDA, PDB, PDC, GEO, BGEO; each also with .gz). A
/// PLY or OBJ file without faces is a point cloud. Normals come out unit length; what a file lacks stays empty. Throws
/// an input Error with file and line, or byte offset, what was expected and what is valid.
Shape readShape(const std::string& path);

/// The same for bytes in memory: `path` gives the ending, messages, and the folder that a .gltf looks for its buffers
/// in.
Shape parseShape(std::string_view bytes, const std::string& path);

/// As readShape; a point cloud where a mesh is wanted (or the reverse) is an input Error.
Mesh readMesh(const std::string& path);
PointCloud readPointCloud(const std::string& path);

/// OBJ or binary PLY; PTC or binary PLY. Read back, all is as it was, but for PTC's normals (1e-4 rad away from the
/// poles) and, in OBJ, normals and uvs of vertices that no triangle uses. Written aside and renamed. Throws a usage
/// Error for another ending.
void writeMesh(const std::string& path, const Mesh& mesh);
void writePointCloud(const std::string& path, const PointCloud& cloud);

/// Endings that can be read, with the dot: for file dialogs and hints.
std::vector<std::string> shapeEndings();

}  // namespace searchlight
