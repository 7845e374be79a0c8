#include "io/shape_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "base/error.h"
#include "base/files.h"
#include "base/text.h"
#include "io/gunzip.h"
#include "io/shape_formats.h"

namespace searchlight {

namespace {

struct ShapeFormat {
    std::string_view ending;
    Shape (*parse)(std::string_view bytes, const std::string& path);
};

// The order is that of file dialogs.
constexpr ShapeFormat kFormats[] = {
    {".obj", parseObj}, {".ply", parsePly}, {".gltf", parseGltf}, {".glb", parseGltf},
    {".off", parseOff}, {".stl", parseStl}, {".ptc", parsePtc},   {".pda", parsePda},
    {".pdb", parsePdb}, {".pdc", parsePdc}, {".geo", parseGeo},   {".bgeo", parseBgeo},
};

constexpr std::string_view kPacked = ".gz";

std::string lowerCase(std::string_view text) {
    std::string lower(text);
    std::ranges::transform(lower, lower.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return lower;
}

std::string_view endingOf(std::string_view path) {
    const std::string_view name = path.substr(path.find_last_of('/') + 1);
    const std::size_t dot = name.find_last_of('.');
    return dot == std::string_view::npos ? std::string_view{} : name.substr(dot);
}

std::string_view kindOf(const Shape& shape) { return std::holds_alternative<Mesh>(shape) ? "mesh" : "point cloud"; }

template <class Kind>
Kind only(Shape shape, const std::string& path) {
    if (Kind* kind = std::get_if<Kind>(&shape)) return std::move(*kind);
    throw inputError(fmt::format("holds a {}, expected a {}", kindOf(shape), kindOf(Kind{}))).at(path);
}

}  // namespace

Shape parseShape(std::string_view bytes, const std::string& path) {
    std::string lower = lowerCase(path);
    if (bytes.size() > kMostShapeBytes) throw inputError("is larger than 2048 MiB").at(path);
    std::string unpacked;
    if (lower.ends_with(kPacked)) {
        unpacked = gunzip(bytes, path);
        bytes = unpacked;
        lower.resize(lower.size() - kPacked.size());
    }
    const std::string_view ending = endingOf(lower);
    for (const ShapeFormat& format : kFormats) {
        if (format.ending != ending) continue;
        if (bytes.empty()) throw inputError("is empty").at(path);
        return format.parse(bytes, path);
    }
    throw inputError(fmt::format("'{}' is no ending of a mesh or point cloud", ending),
                     fmt::format("valid: {}, each also with {}", join(shapeEndings(), ", "), kPacked))
        .at(path);
}

Shape readShape(const std::string& path) { return parseShape(readFile(path, kMostShapeBytes), path); }

Mesh readMesh(const std::string& path) { return only<Mesh>(readShape(path), path); }

PointCloud readPointCloud(const std::string& path) { return only<PointCloud>(readShape(path), path); }

void writeMesh(const std::string& path, const Mesh& mesh) {
    const std::string ending = lowerCase(endingOf(path));
    if (ending == ".obj")
        writeFile(path, objBytes(mesh));
    else if (ending == ".ply")
        writeFile(path, plyBytes(mesh));
    else
        throw usageError(fmt::format("'{}' is no ending that a mesh is written with", ending), "valid: .obj, .ply")
            .at(path);
}

void writePointCloud(const std::string& path, const PointCloud& cloud) {
    const std::string ending = lowerCase(endingOf(path));
    if (ending == ".ptc")
        writeFile(path, ptcBytes(cloud));
    else if (ending == ".ply")
        writeFile(path, plyBytes(cloud));
    else
        throw usageError(fmt::format("'{}' is no ending that a point cloud is written with", ending),
                         "valid: .ptc, .ply")
            .at(path);
}

std::vector<std::string> shapeEndings() {
    std::vector<std::string> endings;
    for (const ShapeFormat& format : kFormats) endings.emplace_back(format.ending);
    return endings;
}

}  // namespace searchlight
