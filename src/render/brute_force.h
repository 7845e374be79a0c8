// The sum itself: every point for every receiver.
#pragma once

#include "render/technique.h"

namespace searchlight {

/// Always on the CPU; the model's evaluator may be on OpenGL.
std::unique_ptr<Technique> makeBruteForce(gl::Context* context);

}  // namespace searchlight
