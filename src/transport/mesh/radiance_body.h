// The radiance reference: what a camera sees of the light that has crossed a closed body, unbiased per pixel.
#pragma once

#include <cstdint>
#include <vector>

#include "base/observer.h"
#include "scene/medium.h"
#include "transport/mesh/camera_source.h"
#include "transport/mesh/closed_body.h"
#include "transport/walk/walk_state.h"

namespace searchlight {

struct BodyRadianceOptions {
    std::uint64_t walks_per_pixel = 64;
    std::uint64_t seed = 1;
    int threads = 0;          ///< 0: all
    bool large_steps = true;  ///< false: each collision is walked, to check with
    WalkControl control;
};

/// One channel, in the unit of the lights' radiance; pixels in rows from the top. Light that the surface mirrors and
/// what lies behind the body are no part of it; scattering by the walk, single scattering included, and light that
/// passes without scattering are.
struct BodyRadiance {
    std::vector<double> radiance;
    std::vector<double> standard_error;  ///< never below that of one walk of the picture's mean brightness
    std::uint64_t walks = 0;             ///< camera rays, those beside the body included
    std::uint64_t collisions = 0, rays = 0, lost = 0;
    /// See FacetBeams: the part of the light that enters which is missing, as it is mirrored more than `orders` times
    /// before it scatters.
    double mirrored = 0;
    std::size_t orders = 0;
    double seconds = 0;  ///< wall time of walking
    int threads = 0;
    bool interrupted = false;
};

/// Walks from the camera. Where walks leave, they collect the radiance of lights with an extent. Points and single
/// directions are asked at collisions: at eta 1, where all lights are, by a shadow ray, behind the refractive facets of
/// a mesh, where small discs are as well, by its beams (facet_beams.h), in a refractive Ball by its rays
/// (sphere_beams.h). The result does not depend on threads. Throws an input Error for a PencilLight, a channel that
/// does not scatter and a mesh that crosses itself; interruptedError() when the observer cancels and the control has no
/// state.
BodyRadiance walkRadiance(const Ball& body, const Medium& medium, int channel, const Illumination& light,
                          const CameraRays& camera, const BodyRadianceOptions& options, Observer& observer);
BodyRadiance walkRadiance(const MeshBody& body, const Medium& medium, int channel, const Illumination& light,
                          const CameraRays& camera, const BodyRadianceOptions& options, Observer& observer);

}  // namespace searchlight
