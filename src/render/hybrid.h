// The hybrid technique [Chang2007, sec. 3.3]: the far part of R_d over few samples of the whole surface, the near part
// over samples around each receiver. docs/hybrid.md says what is promised.
#pragma once

#include <memory>
#include <vector>

#include "render/technique.h"

namespace searchlight {

/// "samples", "atlas", "uvs" and "footprint" of the global part, "local", "local_samples" and "light_map" of the local
/// one, "split" between them.
std::vector<Param> hybridOptions();

/// On the CPU, also where a context is given.
std::unique_ptr<Technique> makeHybrid(gl::Context* context);

}  // namespace searchlight
