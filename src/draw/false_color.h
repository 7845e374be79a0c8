// Maps in false colour, and the bar that tells what the colours mean.
#pragma once

#include <string>
#include <vector>

#include "base/figure.h"
#include "draw/clip.h"
#include "draw/drawing.h"

namespace searchlight {

/// The scale's range: as asked for, or that of the maps. Throws an input Error when a map is malformed, its values
/// cannot be shown, or the range is not one.
Axis colorAxis(const Axis& asked, const std::vector<const FalseColor*>& maps);

/// A map that fills the frame (a hemisphere: the largest disc in it, with rings at 30 and 60 degrees).
void drawMap(std::vector<Shape>& shapes, const FalseColor& map, const Axis& color, const Rect& frame);

/// "5 mm" under a bar of that length, in the lower left corner of a map.
void drawScaleBar(std::vector<Shape>& shapes, const FalseColor& map, const std::string& unit, const Rect& frame);

/// Width of the bar with its numbers and its label.
double colorBarWidth(const Axis& color);

/// The bar, with its left edge and its height given by `bar`.
void drawColorBar(std::vector<Shape>& shapes, const Axis& color, const Rect& bar);

}  // namespace searchlight
