// Irradiance to judge kernels on: pictures made here, of which none was used to find a kernel.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/image.h"

namespace searchlight {

struct Signal {
    std::string_view name;   ///< "edge"
    std::string_view shows;  ///< one line
    Image (*make)(int size);
};

/// In the order of tables: an upright edge and a tilted one, discs, a circle with two tilted squares as in [Freude2014]
/// Fig. 6.6, points, and patches of skin, shaded and evenly lit, as in Fig. 5.10 and 5.12. All repeat beyond their
/// sides and lie within [0, 1].
std::span<const Signal> signals();

}  // namespace searchlight
