// The hierarchical sum on OpenGL as a technique.
#pragma once

#include "render/technique.h"

namespace searchlight {

/// For any model: a radial one by its profile and its derivatives, others by their own GLSL at points that stand for
/// nodes. Takes the option "error", a relative RMSE over the receivers as SumOptions has it, and finds how far nodes
/// have to be opened for it by a full sum for some of the receivers (256, or 32 of another model). After that a step is
/// about 20 ms of the device. `context` is not null and outlives the technique.
std::unique_ptr<Technique> makeHierarchicalGl(gl::Context* context);

}  // namespace searchlight
