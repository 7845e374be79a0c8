// A drawing as SVG. Only shapes and text: no style sheets, no ids, so that many may stand in one page.
#pragma once

#include <string>
#include <string_view>

#include "base/figure.h"
#include "draw/drawing.h"

namespace searchlight {

/// For text and attributes of XML and HTML: & < > " escaped; what is no valid UTF-8, or no character of XML, becomes
/// U+FFFD.
std::string escapeXml(std::string_view text);

/// One <svg> element with the figure's title and metadata; positions are rounded to 0.01 px.
std::string svgElement(const Drawing& drawing, const Figure& figure);

}  // namespace searchlight
