#include "gui/material/material_dock.h"

#include <QWidget>

namespace searchlight::gui {

QWidget* makeMaterialDock(Desk&) { return new QWidget; }

}  // namespace searchlight::gui
