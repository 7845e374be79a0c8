// Lit spheres: a model and the walks side by side, both growing.
#pragma once

#include <vector>

#include "base/param.h"
#include "gui/window/desk.h"

class QWidget;

namespace searchlight::gui {

QWidget* makeSpheresDock(Desk& desk);

/// Exposure, difference, samples: a section of the workspace.
std::vector<Param> spheresOptions();

}  // namespace searchlight::gui
