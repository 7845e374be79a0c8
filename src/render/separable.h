// Light at the visible pixels, blurred by a separable kernel: docs/separable.md.
#pragma once

#include <memory>
#include <vector>

#include "render/technique.h"

namespace searchlight {

/// The options of the technique, with the defaults that were nearest to the hierarchical sum.
std::vector<Param> separableOptions();

/// On a context the passes of the filter run there; what shines through is found by rays in any case. Reads the
/// irradiance at the visible samples.
std::unique_ptr<Technique> makeSeparable(gl::Context* context);

}  // namespace searchlight
