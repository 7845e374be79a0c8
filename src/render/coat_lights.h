// The lights of a scene as a coat sees them: directions worth asking for, and what comes from there. Internal to coat.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "base/vec.h"
#include "geometry/object.h"
#include "geometry/rays.h"
#include "render/coat.h"
#include "scene/scene.h"

namespace searchlight {

/// A point of the surface with its frame: tangent, bitangent and normal are x, y and z.
struct CoatPoint {
    Vec3 position, tangent, bitangent, normal, geometric_normal;
    Vec3 wo;  ///< in the frame

    Vec3 world(Vec3 local) const { return local.x * tangent + local.y * bitangent + local.z * normal; }
    Vec3 local(Vec3 world) const { return {dot(world, tangent), dot(world, bitangent), dot(world, normal)}; }
};

/// How a reflection would choose wi, in the frame of the point.
struct CoatChoice {
    std::function<Vec3(double u, double v)> sample;
    std::function<double(Vec3 wi)> pdf;
};

class CoatLights {
public:
    /// Opens the pictures of the scene.
    CoatLights(const Scene& scene, const Object& object, const RayScene* rays, const CoatOptions& options);
    ~CoatLights();

    /// Calls take(wi, weight), wi in the frame and above it: the sum of weight times BRDF is an estimate of the
    /// radiance reflected by all lights, unbiased over the seeds, exact for light from single directions. Lights with
    /// an extent are asked both by their own choice of directions and by `choice` [Veach1995, balance heuristic].
    void gather(const CoatPoint& point, std::uint64_t seed, const CoatChoice& choice,
                const std::function<void(Vec3 wi, Rgb weight)>& take) const;

    /// Radiance that arrives from wi, in the frame, of the lights that have an extent: what a mirror shows.
    Rgb radianceFrom(const CoatPoint& point, Vec3 wi) const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace searchlight
