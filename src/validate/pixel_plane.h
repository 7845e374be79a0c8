// One value per pixel, and what filters do with it. Internal to this folder.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace searchlight {

/// Rows from the top, as in Image.
struct PixelPlane {
    int width = 0, height = 0;
    std::vector<float> values;  ///< width * height

    PixelPlane(int width_, int height_)
        : width(width_),
          height(height_),
          values(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_)) {}
};

/// `along_x` over the rows, then `along_y` over the columns: both odd in length, centred. Beyond
/// the edges the plane goes on with the value at the edge.
PixelPlane filtered(const PixelPlane& plane, std::span<const float> along_x, std::span<const float> along_y,
                    int threads);

}  // namespace searchlight
