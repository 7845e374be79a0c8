// Separable kernels in the window: beside the truth, on pictures, and with their errors.
#pragma once

#include "gui/window/desk.h"

class QWidget;

namespace searchlight::gui {

/// Computes on a lane of its own, and only while it is seen.
QWidget* makeKernelDock(Desk& desk);

}  // namespace searchlight::gui
