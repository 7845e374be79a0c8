// From linear pictures to what a display shows: exposure, curve, channel; differences in false colour.
#pragma once

#include <QImage>
#include <string>

#include "base/image.h"
#include "io/image_file.h"

namespace searchlight::gui {

/// `channel`: "color", "red", "green", "blue", "luminance"; one channel is shown in grey. Premultiplied, of the
/// picture's size.
QImage shownImage(const Image& picture, const ToneMap& tone_map, const std::string& channel);

/// (a - b) over the mean of b, in a diverging scale whose ends are -scale and +scale; transparent where neither covers.
/// Both have one size.
QImage differenceImage(const Image& a, const Image& b, double scale, const std::string& channel);

/// The colour of a difference from -1 (blue) by 0 (nearly white) to 1 (orange).
QRgb differenceColor(double value);

/// Root mean square of (a - b) over the mean of b, where either covers; NaN when b is dark. Both have one size.
double relativeDifference(const Image& a, const Image& b, const std::string& channel);

}  // namespace searchlight::gui
