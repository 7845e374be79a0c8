// A picture that parallel light passes on its way: stained glass, a slide, clouds.
#pragma once

#include <string>
#include <vector>

#include "base/image.h"
#include "base/vec.h"

namespace searchlight {

/// A picture perpendicular to the light, its centre on the line through the object's centre; its shorter side spans the
/// bounding sphere, so that nothing of the object lies beside it. It is seen upright and unmirrored by who looks along
/// the light, +y being up; where the light comes straight down (up), the picture's top points to -z (+z).
///
/// The light that passes a pixel is colour + (1 - alpha): an opaque pixel is glass of that colour, a transparent one a
/// hole. Negative colours pass nothing.
class LightFilter {
public:
    /// Opens the picture. `direction`: towards the light, not 0; `radius_mm`: of the bounding sphere around 0.
    LightFilter(const std::string& path, Vec3 direction, double radius_mm);
    /// The same with a picture in memory; throws an input Error that calls it `name` where a value is infinite or not a
    /// number.
    LightFilter(const Image& picture, const std::string& name, Vec3 direction, double radius_mm);

    /// What passes on the way to `position`, mm, averaged over about width_mm (0: bilinear between pixels).
    Rgb operator()(Vec3 position, double width_mm) const;

private:
    Vec3 right_, up_;
    double pixel_mm_ = 0;
    std::vector<Image> levels_;  ///< each half as wide and high as the one before it, down to one pixel
};

}  // namespace searchlight
