// Light on the points of a surface, after it crossed into the medium.
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

/// Parallel light, or the light of one point of the scene, on every surface point: what models that read wi need.
struct Beam {
    std::vector<Vec3f> wi;   ///< towards the light: one for all points, or one per point
    std::vector<Rgbf> flux;  ///< T12(wi) times irradiance, per point, per mm^2; 0 in shadow
};

/// Flux per mm^2 that crossed into the medium: the integral of T12(wi) L(wi) cos over the hemisphere, with T12 exact.
struct Irradiance {
    std::vector<Rgbf> transmitted;  ///< one per point
    std::vector<Beam> beams;        ///< add up to `transmitted`; empty unless asked for
};

struct SurfacePoints {
    std::span<const Vec3f> positions;  ///< mm, in the object's place
    std::span<const Vec3f> normals;
};

struct IrradianceOptions {
    double eta = 1.3;
    bool beams = false;        ///< also as beams
    int beam_count = 16;       ///< of those that one environment becomes [Frisvad2014, sec. 4]
    int light_samples = 4096;  ///< directions by which an occluded environment is summed, shared by all points
    std::uint64_t seed = 1;
    int threads = 0;
};

/// All lights of the scene on all points; `rays` (the object in place; null: nothing casts shadows) decides what is in
/// shadow. Paths of pictures are opened here. Throws an input Error for a picture that cannot be used,
/// interruptedError() when cancelled.
Irradiance computeIrradiance(const SurfacePoints& points, const Scene& scene, const Object& object,
                             const RayScene* rays, const IrradianceOptions& options, Observer& observer);

}  // namespace searchlight
