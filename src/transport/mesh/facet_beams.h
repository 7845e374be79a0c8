// Light from single directions and points inside a refractive mesh, before it scatters: behind each facet that it meets
// there is a beam whose direction and strength at a point are known in closed form. So a walk from the camera needs
// not meet such light, nor be joined to walks from it: each collision sums the beams that pass through it, and there is
// nothing to blow up where two walks come close.
#pragma once

#include <cstdint>
#include <vector>

#include "light/light_sampler.h"
#include "transport/mesh/body_walk.h"
#include "transport/mesh/closed_body.h"
#include "transport/walk/random.h"

namespace searchlight {

/// The beams of one channel's medium. What a beam has left after kReach mean free paths, 8e-7 of it, and what is
/// mirrored inside before it scatters (mirrored()) is no part. Immutable; queries may run on many threads at once.
class FacetBeams {
public:
    static constexpr double kReach = 14;  ///< mean free paths

    /// Body and lights outlive their use; eta is not 1. Throws an input Error when the lists would not fit in memory.
    FacetBeams(const MeshBody& body, const BodyMedium& medium, const LightSampler& lights, int channel);

    /// Radiance that one collision at `position` scatters into a walk that came there in `direction` (unit) from the
    /// camera, over the square of eta. Counts its rays.
    double scattered(Vec3f position, Vec3 direction, SplitMix64& random, std::uint64_t& rays) const;

    /// The part of the light that enters the body which meets its surface again unscattered and is mirrored there.
    double mirrored() const { return mirrored_; }

private:
    // The point (u, v) of a facet from which light gets to a position x after the distance t: each is row . x +
    // constant. Behind light from a point u and v are off by up to the slack times t.
    struct Beam {
        std::uint32_t triangle = 0, light = 0;
        bool parallel = false;
        float slack = 0;
        Vec3f rows[3];
        float constants[3] = {};
    };
    // How light arrives inside.
    struct Arrival {
        Vec3 entry, wi, direction;  // where, from where outside, and to where inside
        double distance = 0;        // from the entry, mm
        double irradiance = 0;      // without what is lost on the way through the medium
        double light_distance = 0;
    };

    void addBeams(std::uint32_t light);
    void fillCells();
    template <class Visit>
    void forEachCell(const Beam& beam, const Visit& visit) const;
    std::size_t cellOf(Vec3f position) const;
    bool arrive(const Beam& beam, Vec3 position, Arrival& arrival) const;
    double measureMirrored() const;

    const MeshBody& body_;
    BodyMedium medium_;
    const LightSampler& lights_;
    int channel_;
    std::vector<Beam> beams_;
    Vec3 low_;
    double cell_mm_ = 0, reach_mm_ = 0;
    std::int32_t nx_ = 1, ny_ = 1, nz_ = 1;
    std::vector<std::uint32_t> first_, list_;  // of each cell, the beams that may pass through it
    double mirrored_ = 0;
};

}  // namespace searchlight
