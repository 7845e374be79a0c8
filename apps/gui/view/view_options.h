// How the object view shows what was rendered: a section of the workspace.
#pragma once

#include <vector>

#include "base/param.h"

namespace searchlight::gui {

/// Exposure, tone curve, channels, layer, comparison.
std::vector<Param> viewOptions();

}  // namespace searchlight::gui
