// The searchlight plot: curves of the models beside the reference, live.
#pragma once

#include "gui/window/desk.h"

class QWidget;

namespace searchlight::gui {

QWidget* makePlotDock(Desk& desk);

}  // namespace searchlight::gui
