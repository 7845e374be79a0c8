// A picture in memory: linear, scene-referred, 32-bit float.
#pragma once

#include <cassert>
#include <string>
#include <utility>
#include <vector>

#include "base/vec.h"

namespace searchlight {

/// Radiance over alpha-premultiplied coverage: r, g, b are linear Rec. 709, a is the covered fraction of the pixel.
struct Rgba {
    float r = 0, g = 0, b = 0, a = 1;
    bool operator==(const Rgba&) const = default;
};

/// Rows from the top, pixels from the left.
struct Image {
    int width = 0, height = 0;
    std::vector<Rgba> pixels;  ///< width * height

    Image() = default;
    Image(int width_, int height_, Rgba fill = {0, 0, 0, 0})
        : width(width_), height(height_), pixels(static_cast<std::size_t>(width_) * height_, fill) {}

    bool empty() const { return pixels.empty(); }
    Rgba& at(int x, int y) {
        assert(x >= 0 && x < width && y >= 0 && y < height);
        return pixels[static_cast<std::size_t>(y) * width + x];
    }
    const Rgba& at(int x, int y) const { return const_cast<Image*>(this)->at(x, y); }
};

/// A further picture of the same size: a standard error, a depth.
struct ImageLayer {
    std::string name;  ///< "stderr", "normal"
    Image image;
};

/// What an image file holds.
struct ImageFile {
    Image image;
    std::vector<ImageLayer> layers;
    std::vector<std::pair<std::string, std::string>> metadata;  ///< "job", "seed", "version": text attributes
};

}  // namespace searchlight
