// How far light is blurred where: a picture over the texture coordinates of a mesh.
#pragma once

#include <string>
#include <vector>

#include "geometry/object.h"
#include "geometry/rays.h"
#include "render/view.h"

namespace searchlight {

/// Luminance of the picture at each visible sample, bilinear, repeated beyond its edges. 1 blurs as the material does,
/// 0 not at all. Throws an input Error where the mesh has no texture coordinates, or the picture is none that lengths
/// can be multiplied by: unreadable, or with values that are not from 0 to 1000.
std::vector<float> strengthAt(const std::string& path, const VisibleSurface& visible, const Object& object,
                              const RayScene& rays, int threads);

}  // namespace searchlight
