// What stands around plots: titles, labels, legend entries, captions.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/figure.h"
#include "draw/drawing.h"
#include "draw/legend.h"

namespace searchlight {

inline constexpr double page_margin = 16;
inline constexpr double title_size = 14, label_size = 13, caption_size = 11;
inline constexpr double title_line = 19, caption_line = 15;
inline constexpr std::string_view soft_ink = "#4d4d4d";

/// "Radius (mm)".
std::string axisText(const Axis& axis);

/// One entry for each series that has one; says where a logarithmic axis hides negative values.
std::vector<LegendEntry> legendEntries(const Figure& figure);

/// "×10⁻⁵" at the end of an axis whose labels are to be multiplied by it; starts at `at`.
void drawFactor(std::vector<Shape>& shapes, Point at, int exponent);

/// Lines of the title, bold, the first on a base line near `top`.
void drawTitle(std::vector<Shape>& shapes, const std::vector<std::string>& lines, double left, double top);

/// Lines of the caption, below `top`.
void drawCaption(std::vector<Shape>& shapes, const std::vector<std::string>& lines, double top);

}  // namespace searchlight
