// Where an axis is marked, and what is written there.
#pragma once

#include <string>
#include <vector>

#include "base/figure.h"

namespace searchlight {

struct Tick {
    double value = 0;
    bool major = false;            ///< long, with a grid line; others are short
    std::string label = {};        ///< "0.5", or the base "10" of a power; empty: unlabelled
    std::string superscript = {};  ///< the exponent; empty: none
};

struct AxisTicks {
    std::vector<Tick> ticks;  ///< ascending
    int factor = 0;           ///< labels are to be multiplied by 10^factor
};

/// Marks for [min, max] with about `target` labels. min < max, finite; both positive for a logarithmic axis.
AxisTicks axisTicks(AxisScale scale, double min, double max, int target);

/// One mark for each name, at 0, 1, 2...
AxisTicks namedTicks(const std::vector<std::string>& names);

}  // namespace searchlight
