// The table of sections. A dock that keeps options in the workspace states them as Params in its own folder, and adds
// its row here.
#include "gui/kernel/kernel_options.h"
#include "gui/plot/plot_options.h"
#include "gui/spheres/spheres_dock.h"
#include "gui/state/state.h"
#include "gui/view/view_options.h"

namespace searchlight::gui {

const std::vector<Section>& sections() {
    static const std::vector<Section> list{
        {"view", viewOptions()},
        {"plot", plotOptions()},
        {"spheres", spheresOptions()},
        {"kernel", kernelOptions()},
    };
    return list;
}

}  // namespace searchlight::gui
