#include "gui/window/docks.h"

#include "gui/lights/lights_dock.h"
#include "gui/material/material_dock.h"

namespace searchlight::gui {

std::span<const DockEntry> docks() {
    static constexpr DockEntry entries[] = {
        {"material", "Material", "What the object is made of", Qt::LeftDockWidgetArea, "Ctrl+1", "material", true,
         makeMaterialDock},
        {"lights", "Lights", "What shines on the object", Qt::LeftDockWidgetArea, "Ctrl+2", "lights", true,
         makeLightsDock},
    };
    return entries;
}

}  // namespace searchlight::gui
