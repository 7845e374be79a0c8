// Several small plots on one page, and plots in false colour.
#pragma once

#include "base/figure.h"
#include "draw/drawing.h"

namespace searchlight {

/// For a figure with panels or a map; throws an input Error as layoutFigure does, and for panels within panels.
Drawing layoutPanels(const Figure& figure);

}  // namespace searchlight
