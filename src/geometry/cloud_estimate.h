// What a point cloud lacks, from each point's neighbours.
#pragma once

#include <span>
#include <vector>

#include "scene/point_cloud.h"

namespace searchlight {

/// Unit normals of the planes that fit 12 neighbours best. They point to where a flood from outside comes, and are
/// turned alike, along a minimum spanning tree over those who differ least [Hoppe1992], where it comes to both sides or
/// none: in thin or open parts; where none is sure, what is highest points up. Fewer than three points get +y.
std::vector<Vec3f> estimateNormals(std::span<const Vec3f> positions, int threads = 0);

/// Area per point: that of the disc that reaches to its 12th neighbour, shared by those in it. A few percent high at
/// edges, where half the disc is empty.
std::vector<float> estimateAreas(std::span<const Vec3f> positions, int threads = 0);

}  // namespace searchlight
