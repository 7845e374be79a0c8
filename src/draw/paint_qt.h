// PNG, JPEG and PDF through Qt. Compiled in builds with Qt only.
#pragma once

#include <string>

#include "base/figure.h"
#include "draw/drawing.h"

namespace searchlight {

/// Two image pixels for each px of the drawing, as "PNG" or "JPG", with the figure's title and metadata as texts.
/// Throws a device Error when no font is installed.
std::string drawingBitmap(const Drawing& drawing, const Figure& figure, const char* format);

/// The figure laid out, as PNG. Throws as drawingBitmap does.
std::string figurePng(const Figure& figure);

/// One page of the figure's size, vector; metadata as XMP. Throws as figurePng does.
std::string figurePdf(const Figure& figure);

}  // namespace searchlight
