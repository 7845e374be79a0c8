// The text of the active model: edited, checked while one types, live in every picture once it works.
#pragma once

#include "gui/window/desk.h"

class QWidget;

namespace searchlight::gui {

QWidget* makeEditorDock(Desk& desk);

}  // namespace searchlight::gui
