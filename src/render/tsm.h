// The local translucent shadow map [Chang2007, sec. 3.3.2]: light is gathered from what the lights see.
// docs/hybrid.md says what is promised.
#pragma once

#include <memory>
#include <vector>

#include "render/technique.h"

namespace searchlight {

/// "local_samples" and "light_map": of whoever filters what a light sees.
std::vector<Param> lightViewOptions();

/// On the CPU, also where a context is given.
std::unique_ptr<Technique> makeTsm(gl::Context* context);

}  // namespace searchlight
