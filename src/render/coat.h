// The surface on top of the subsurface light: what is reflected without entering.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/observer.h"
#include "base/vec.h"
#include "geometry/object.h"
#include "geometry/rays.h"
#include "scene/scene.h"

namespace searchlight {

namespace gl {
class Context;
}

/// Where the coat is asked for, one of each per sample; directions are unit.
struct CoatSamples {
    std::span<const Vec3f> positions;  ///< mm
    std::span<const Vec3f> normals;    ///< for shading
    std::span<const Vec3f> geometric_normals;
    std::span<const Vec3f> wo;  ///< towards the viewer
};

struct CoatOptions {
    double eta = 1.3;          ///< inside over outside
    int disc_samples = 16;     ///< per light that is a disc, half of them by the reflection
    int picture_samples = 64;  ///< per environment, half of them by the reflection
    std::uint64_t seed = 1;
    int threads = 0;
    gl::Context* context = nullptr;  ///< for a .brdf file, which is evaluated on OpenGL
};

/// Radiance towards wo that the lights of the scene leave on the surface's coat, per sample. Requires scene.coat.
/// `rays` (the object in place; null: nothing casts shadows) decides what is in shadow; light by way of other surfaces
/// is left out, and so is what an environment without `occlusion` has the object in front of. Files that the scene
/// names are opened here. Throws an input Error for one that cannot be used, a device Error for a .brdf file without
/// OpenGL, interruptedError() when cancelled.
std::vector<Rgbf> coatRadiance(const CoatSamples& samples, const Scene& scene, const Object& object,
                               const RayScene* rays, const CoatOptions& options, Observer& observer);

}  // namespace searchlight
