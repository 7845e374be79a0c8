// What is seen where the object is not: the ground, a colour or the surroundings.
#pragma once

#include <cstdint>

#include "base/image.h"
#include "base/observer.h"
#include "geometry/object.h"
#include "geometry/rays.h"
#include "render/view.h"
#include "scene/scene.h"

namespace searchlight {

struct BackgroundOptions {
    std::uint64_t seed = 1;
    int threads = 0;
};

/// Radiance per pixel with alpha 1 where the scene has a ground, a backdrop or an environment, and 0 elsewhere; an
/// empty picture where it has none of them. Pixels that the object covers wholly stay empty. The ground is diffuse and
/// in the object's shadow (`rays`; null: none); light that leaves the object does not reach it.
Image paintBackground(const View& view, const Scene& scene, const Object& object, const RayScene* rays,
                      const VisibleSurface& visible, const BackgroundOptions& options, Observer& observer);

}  // namespace searchlight
