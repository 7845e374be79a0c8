// Pictures that are lights: read, checked, and brought to latitude-longitude.
#pragma once

#include <string>

#include "base/image.h"
#include "scene/scene.h"

namespace searchlight {

/// The picture of an environment as latitude-longitude, 2:1 within 1 %, negative values (of which files hold some, left
/// by filters) set to 0. Throws an input Error that calls the picture `name`: no such shape, a ball that is not square,
/// a value that is infinite or not a number.
Image latitudeLongitude(Image picture, const std::string& layout, const std::string& name);

/// Throws an input Error where a value is infinite or not a number, or there is no pixel.
void checkPicture(const Image& picture, const std::string& name);

/// The mean of `picture` over the pixels of a smaller or equal size, by area.
Image shrunk(const Image& picture, int width, int height);

}  // namespace searchlight
