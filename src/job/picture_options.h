// What commands that write pictures have in common.
#pragma once

#include <string>
#include <string_view>

namespace searchlight {

/// Of a picture, in pixels.
struct PictureSize {
    int width = 0, height = 0;
};

/// "640x480": each a whole number from 1 to 16384. Throws a usage Error that says so.
PictureSize parsePictureSize(std::string_view text);

/// Throws a usage Error that lists the endings unless `output` is empty or ends like a picture that can be written.
void checkPictureEnding(const std::string& output);

}  // namespace searchlight
