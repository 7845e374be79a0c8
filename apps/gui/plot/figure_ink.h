// Colours of figures in the window.
#pragma once

#include "draw/paint_qt.h"

namespace searchlight::gui {

class Theme;

/// Paper and greys become the theme's panel, lines and text; colours of series are lightened where it is dark.
InkFunction figureInk(const Theme& theme);

}  // namespace searchlight::gui
