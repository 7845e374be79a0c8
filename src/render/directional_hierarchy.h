// The hierarchical technique for models that are not radial, on the CPU.
#pragma once

#include <memory>

#include "render/technique.h"

namespace searchlight {

/// Takes inputs without a profile, and the option "error". docs/hierarchical.md says what is promised.
std::unique_ptr<Technique> makeDirectionalHierarchy();

}  // namespace searchlight
