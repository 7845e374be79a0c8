// PNG and PDF through Qt. Compiled in builds with Qt only.
#pragma once

#include <string>

#include "base/figure.h"

namespace searchlight {

/// Two image pixels for each px of the layout; metadata as PNG text. Throws a device Error when no font is installed.
std::string figurePng(const Figure& figure);

/// One page of the figure's size, vector; metadata as XMP. Throws as figurePng does.
std::string figurePdf(const Figure& figure);

}  // namespace searchlight
