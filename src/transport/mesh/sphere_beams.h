// Light from single directions and points inside a smooth refractive sphere, before it scatters. A ray stays in the
// plane through the centre, the light and where it enters, and its sine falls as 1/r, so that the angle that it has
// turned by at a radius is known in closed form. So the rays that pass through a place, refracted in and mirrored any
// number of times, are the roots of a function of one variable; all of them are found.
//
// Light diverges on caustics, as the inverse root of the distance, and as the inverse distance from the axis that
// mirrored rays cross: integrably, but with squares that are not. So a flight of a walk is asked in three ways,
// weighted by the balance heuristic [Veach1995]: where it ends in a collision, for all rays through there; for one ray
// drawn by flux, where the flight meets it or one that is turned about the axis, which stays finite on caustics; at a
// place that is drawn as the inverse distance from the axis, for all rays.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/random.h"
#include "light/light_sampler.h"
#include "transport/mesh/body_walk.h"
#include "transport/mesh/closed_body.h"

namespace searchlight {

/// The light of one channel before it scatters, unbiased. Nothing is left out: light that the surface mirrors from
/// inside is followed to an order that is drawn. Immutable; queries may run on many threads at once.
class SphereBeams {
public:
    /// Body and lights outlive their use; eta is not 1. Points within the sphere give no light. `along`: false leaves
    /// all to collisions, to check with.
    SphereBeams(const Ball& body, const BodyMedium& medium, const LightSampler& lights, int channel, bool along = true);

    /// Radiance that the collision at the end of a flight from `from` scatters into a walk that came in `direction`
    /// (unit) from the camera, over the square of eta.
    double atCollision(Vec3f from, Vec3 direction, double length_mm, SplitMix64& random) const;

    /// The rest of what a flight collects, whether or not it ends in a collision.
    double alongFlight(Vec3f from, Vec3 direction, SplitMix64& random) const;

private:
    struct Source {
        std::size_t light = 0;
        Vec3 axis;            // from the centre towards the light
        double nearness = 0;  // radius over the distance of the light
    };
    struct Flight;
    struct Pass;

    Flight flightOf(Vec3f from, Vec3 direction) const;
    double followed(int order) const;
    double allRays(const Flight& flight, double at, SplitMix64& random) const;
    double oneRay(const Flight& flight, SplitMix64& random) const;
    double weighted(const Source& source, const Flight& flight, double at, const Pass& pass) const;

    double radius_ = 1, shortest_chord_ = 0;
    BodyMedium medium_;
    const LightSampler& lights_;
    int channel_;
    std::vector<Source> sources_;
    double ray_part_ = 0, axis_part_ = 0;  // of flights that are asked for a ray, and at a place about an axis
};

}  // namespace searchlight
