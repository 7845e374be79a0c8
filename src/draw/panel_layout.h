// Several small plots on one page, and plots in false colour.
#pragma once

#include "base/figure.h"
#include "draw/drawing.h"

namespace searchlight {

/// For a figure with panels or a map, `width` px wide, or as wide as suits their number (0); without `maps` it is
/// quick, and as large. Throws an input Error as layoutFigure does, and for panels within panels.
Drawing layoutPanels(const Figure& figure, double width = 0, bool maps = true);

}  // namespace searchlight
