// Light that leaves a closed body without having scattered, and after it has scattered once: what diffusion models
// leave to others.
#pragma once

#include <vector>

#include "transport/mesh/reference_body.h"

namespace searchlight {

/// One channel: exitance per cell, flux per mm^2 before T21, in the unit of irradiance, with standard errors. The same
/// light is part of what walkBody() counts.
struct FirstOrders {
    std::vector<double> unscattered, unscattered_error;
    std::vector<double> single, single_error;
};

/// Walks `options.walks` beams, about, as walkBody() lets them enter: each is followed through its reflections from
/// inside, deposits what leaves of it, and scatters once on each leg, with its flux as the weight. No loss by roulette
/// but below 1e-3 of what entered. `single`: false leaves single scattering 0. The result does not depend on threads.
/// Throws as walkBody().
FirstOrders walkFirstOrders(const MeshBody& body, const Medium& medium, int channel, const Illumination& light,
                            const BodyOptions& options, Observer& observer, bool single = true);

}  // namespace searchlight
