// The one layout of figures: SVG, PNG, PDF and the report draw what stands here.
#pragma once

#include "base/figure.h"
#include "draw/drawing.h"

namespace searchlight {

/// Throws an input Error as figureSvg does.
Drawing layoutFigure(const Figure& figure);

}  // namespace searchlight
