// What shines on the object.
#pragma once

#include "gui/window/desk.h"

class QWidget;

namespace searchlight::gui {

QWidget* makeLightsDock(Desk& desk);

}  // namespace searchlight::gui
