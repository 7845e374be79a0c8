// The integral of a BSSRDF over the surface by random points of it, without bias: docs/surface-sampling.md.
#pragma once

#include <memory>
#include <vector>

#include "render/technique.h"

namespace searchlight {

/// The options of the technique.
std::vector<Param> directOptions();

/// Always on the CPU; the model's evaluator may be on OpenGL. Chooses its own points and asks for the light there.
std::unique_ptr<Technique> makeDirect(gl::Context* context);

}  // namespace searchlight
