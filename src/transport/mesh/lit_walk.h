// Walks from a camera whose collisions ask the lights, where no walk would meet them.
#pragma once

#include "light/light_sampler.h"
#include "transport/mesh/body_walk.h"
#include "transport/mesh/camera_source.h"
#include "transport/mesh/closed_body.h"
#include "transport/mesh/sphere_beams.h"

namespace searchlight {

/// At eta 1 light reaches a collision along straight lines: each collision asks one of the lights by a shadow ray, and
/// only walks that pass unscattered collect where they leave.
BodyChunk walkMatchedChunk(const Ball& ball, const BodyMedium& medium, const LightSampler& lights, int channel,
                           CameraSource<Ball>& source, SplitMix64 random);
BodyChunk walkMatchedChunk(const MeshBody& mesh, const BodyMedium& medium, const LightSampler& lights, int channel,
                           CameraSource<MeshBody>& source, SplitMix64 random);

/// In a smooth refractive sphere each flight asks the rays of single directions and points, which is what keeps
/// caustics from being seen; walks that leave collect from lights with an extent.
BodyChunk walkBeamsChunk(const Ball& ball, const BodyMedium& medium, const SphereBeams& beams,
                         CameraSource<Ball>& source, SplitMix64 random);

}  // namespace searchlight
