#include "transport/slab/slab_depths.h"

#include <algorithm>
#include <cmath>

namespace searchlight {

SlabDepths::SlabDepths(const SlabWalk& walk, const SlabLayout& layout)
    : per_mm(static_cast<float>(layout.depthsPerMm())) {
    const double last = static_cast<double>(layout.depths() - 1);
    for (std::size_t i = 0; i < walk.layers.size(); ++i) {
        const double top = layout.layers()[i].top_mm * layout.depthsPerMm();
        const double bottom = top + walk.layers[i].thickness_mm * layout.depthsPerMm();
        Layer layer;
        layer.top = static_cast<float>(top);
        layer.first = static_cast<float>(std::min(std::floor(top), last));
        layer.last = static_cast<float>(std::min(std::floor(bottom), last));
        layer.slot = static_cast<std::int32_t>(slots.size()) - static_cast<std::int32_t>(layer.first);
        for (auto depth = static_cast<std::size_t>(layer.first); depth <= static_cast<std::size_t>(layer.last); ++depth)
            slots.push_back({i, depth});
        layers.push_back(layer);
    }
}

}  // namespace searchlight
