// What the object is made of.
#pragma once

#include "gui/window/desk.h"

class QWidget;

namespace searchlight::gui {

QWidget* makeMaterialDock(Desk& desk);

}  // namespace searchlight::gui
