// What the readers and writers of single formats share; only src/io includes it. Every parse function takes a whole
// file and throws what readShape throws.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/shape_file.h"

namespace searchlight {

Shape parseObj(std::string_view bytes, const std::string& path);
Shape parsePly(std::string_view bytes, const std::string& path);
Shape parseGltf(std::string_view bytes, const std::string& path);
Shape parseOff(std::string_view bytes, const std::string& path);
Shape parseStl(std::string_view bytes, const std::string& path);
Shape parsePtc(std::string_view bytes, const std::string& path);
Shape parsePda(std::string_view bytes, const std::string& path);
Shape parsePdb(std::string_view bytes, const std::string& path);
Shape parsePdc(std::string_view bytes, const std::string& path);
Shape parseGeo(std::string_view bytes, const std::string& path);
Shape parseBgeo(std::string_view bytes, const std::string& path);

std::string objBytes(const Mesh& mesh);
std::string plyBytes(const Mesh& mesh);
std::string plyBytes(const PointCloud& cloud);
std::string ptcBytes(const PointCloud& cloud);

/// The largest file, packed or not.
inline constexpr std::size_t kMostShapeBytes = std::size_t{1} << 31;

inline bool isFinite(Vec3f a) { return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z); }

/// Triangles of the polygon whose corners are those vertices, appended to `triangles`. Concave polygons of up to 128
/// corners are cut at ears, larger ones are fans. Needs 3 corners or more, all of them within `positions`.
void addPolygon(const std::vector<Vec3f>& positions, std::span<const std::uint32_t> corners,
                std::vector<std::array<std::uint32_t, 3>>& triangles);

/// Normals made unit length. One that is zero or not finite becomes the mean of its triangles' normals by area (+z
/// where there are none); when all are, the mesh has no normals.
void finishNormals(Mesh& mesh);

/// Normals made unit length; one that is not finite becomes zero. Normals and areas that are all zero are left out.
void finishCloud(PointCloud& cloud);

/// How an attribute of a point says which area the point stands for.
enum class AreaRule { area, radius, diameter };

/// By the attribute's name: "area" and "_area"; "radius", "radiusPP" and "pscale"; "width" (a diameter).
std::optional<AreaRule> areaRule(std::string_view name);

/// pi r^2, or the value itself; nothing for what is negative or not finite.
std::optional<float> areaOf(AreaRule rule, float value);

}  // namespace searchlight
