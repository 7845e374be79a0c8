// Light gathered from what the eye sees, and from points where it does not see: docs/surface-sampling.md.
#pragma once

#include <memory>
#include <vector>

#include "render/technique.h"

namespace searchlight {

/// The options of the technique.
std::vector<Param> localOptions();

/// Always on the CPU. Reads the irradiance at the visible samples. Radial models.
std::unique_ptr<Technique> makeLocal(gl::Context* context);

}  // namespace searchlight
