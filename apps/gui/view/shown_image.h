// From linear pictures to what a display shows: exposure, curve, channel; differences in false colour.
#pragma once

#include <QImage>
#include <string>
#include <vector>

#include "base/image.h"
#include "io/image_file.h"

namespace searchlight::gui {

/// `channel`: "color", "red", "green", "blue", "luminance"; one channel is shown in grey. Premultiplied, of the
/// picture's size.
QImage shownImage(const Image& picture, const ToneMap& tone_map, const std::string& channel);

/// Without the pixels that show, even in part, what stands around the object. `coverage`: of each pixel by the object.
Image objectAlone(Image picture, const std::vector<float>& coverage);

/// (a - b) over the mean of b, in a diverging scale whose ends are -scale and +scale; transparent where neither covers.
/// Both have one size.
QImage differenceImage(const Image& a, const Image& b, double scale, const std::string& channel);

/// The colour of a difference from -1 (blue) by 0 (nearly white) to 1 (orange).
QRgb differenceColor(double value);

/// How far a picture is from another, over the mean of the other where either covers.
struct PictureDifference {
    double rms = -1;  ///< root mean square; below 0: not compared
    double mean = 0;  ///< signed: above 0 where the picture is brighter
};

/// Of a against b in that channel, "color" being luminance; not compared when b is dark. Both have one size.
PictureDifference relativeDifference(const Image& a, const Image& b, const std::string& channel);

}  // namespace searchlight::gui
