// Lights whose light is computed once and exactly: directional ones and points.
#pragma once

#include <functional>
#include <vector>

#include "base/observer.h"
#include "light/irradiance.h"
#include "light/lit_block.h"
#include "light/transmitted_cosine.h"

namespace searchlight {

/// What every light needs to know of the points.
struct Lighting {
    const LitPoints& points;
    const Object& object;
    const RayScene* rays;  ///< null: nothing casts shadows
    const IrradianceOptions& options;
    TransmittedCosine transmitted_cosine;
    Observer& observer;

    /// Calls body(first, block) for all points in blocks, `first` the place of the block's first point in
    /// points.order, on many threads; the body writes only to its own points. Throws interruptedError() when cancelled.
    void forEachBlock(const std::function<void(std::size_t, LitBlock&)>& body) const;
};

/// Directions within a light's disc, and what one of them gives of the irradiance on a surface that faces the disc.
struct DiscSamples {
    std::vector<Vec3f> directions;
    double weight = 1;
};

/// `count` stratified directions, uniform over the disc: half of them and a quarter are stratified as well when count
/// is a power of two. One, exact, for a light without an angle.
DiscSamples discSamples(const DirectionalLight& light, int count, std::uint64_t seed);

/// The radius of the bounding sphere around the centre of the object, mm.
double boundingRadius(const Object& object);

/// Each adds up to `transmitted` of one light, in the caller's order of points. The beam of a light with an angle has
/// the direction of the disc's centre.
Beam directionalBeam(const Lighting& lighting, const DirectionalLight& light);
Beam pointBeam(const Lighting& lighting, const PointLight& light);

}  // namespace searchlight
