#include "gui/window/docks.h"

#include "gui/editor/editor_dock.h"
#include "gui/kernel/kernel_dock.h"
#include "gui/lights/lights_dock.h"
#include "gui/material/material_dock.h"
#include "gui/models/models_dock.h"
#include "gui/plot/plot_dock.h"
#include "gui/spheres/spheres_dock.h"

namespace searchlight::gui {

std::span<const DockEntry> docks() {
    static constexpr DockEntry entries[] = {
        {"material", "Material", "What the object is made of", Qt::LeftDockWidgetArea, "Ctrl+1", "material", true,
         makeMaterialDock},
        {"lights", "Lights", "What shines on the object", Qt::LeftDockWidgetArea, "Ctrl+2", "lights", true,
         makeLightsDock},
        {"models", "Models", "The models that are compared", Qt::LeftDockWidgetArea, "Ctrl+3", "models", true,
         makeModelsDock},
        {"plot", "Searchlight plot", "Curves of the models beside the reference", Qt::BottomDockWidgetArea, "Ctrl+4",
         "plot", true, makePlotDock},
        {"spheres", "Lit spheres", "A model and random walks on a sphere", Qt::BottomDockWidgetArea, "Ctrl+5",
         "spheres", true, makeSpheresDock},
        {"kernel", "Kernels", "Separable kernels of the material, and how far they are from the truth",
         Qt::BottomDockWidgetArea, "Ctrl+7", "kernel", true, makeKernelDock},
        {"editor", "Editor", "The text of the active model", Qt::RightDockWidgetArea, "Ctrl+6", "editor", true,
         makeEditorDock},
    };
    return entries;
}

}  // namespace searchlight::gui
