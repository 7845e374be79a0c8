// The dual tree as a technique.
#pragma once

#include "render/technique.h"

namespace searchlight {

/// On that context, or on the CPU where it is null.
std::unique_ptr<Technique> makeHierarchical(gl::Context* context);

}  // namespace searchlight
