// Where a raster program draws to.
#pragma once

#include <initializer_list>
#include <vector>

#include "gl/texture.h"

namespace searchlight::gl {

class Framebuffer {
public:
    /// Draws into layer `layer` (of a cube: a face) of textures of one size: color output k of the fragment stage goes
    /// to colors[k]; `depth` may be null. The textures outlive it. Throws a device Error for what the device cannot
    /// draw to.
    Framebuffer(Context& context, std::initializer_list<const Texture*> colors, const Texture* depth, int layer = 0);
    ~Framebuffer();
    Framebuffer(const Framebuffer&) = delete;
    Framebuffer& operator=(const Framebuffer&) = delete;

    int width() const { return width_; }
    int height() const { return height_; }
    unsigned handle() const { return handle_; }

    /// Colors to zero, depth to 1: nothing there.
    void clear();

private:
    Context& context_;
    unsigned handle_ = 0;
    int width_ = 0, height_ = 0;
    std::vector<bool> whole_numbers_;  // per color output
    bool has_depth_;
};

}  // namespace searchlight::gl
