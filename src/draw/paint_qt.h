// PNG, JPEG and PDF through Qt. Compiled in builds with Qt only.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "base/figure.h"
#include "draw/drawing.h"

class QPainter;

namespace searchlight {

/// Another colour ("#rrggbb") for one of a drawing: what is ink on paper is light on a dark window.
using InkFunction = std::function<std::string(std::string_view)>;

/// Shapes on any device of a program that has a QGuiApplication, in the painter's units of 1 px.
void paintShapes(QPainter& painter, const std::vector<Shape>& shapes, const InkFunction& ink = {});

/// Two image pixels for each px of the drawing, as "PNG" or "JPG", with the figure's title and metadata as texts.
/// Throws a device Error when no font is installed.
std::string drawingBitmap(const Drawing& drawing, const Figure& figure, const char* format);

/// The figure laid out, as PNG. Throws as drawingBitmap does.
std::string figurePng(const Figure& figure);

/// One page of the figure's size, vector; metadata as XMP. Throws as figurePng does.
std::string figurePdf(const Figure& figure);

}  // namespace searchlight
