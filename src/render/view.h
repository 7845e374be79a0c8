// What the camera sees: pixels to rays, and the surface behind them.
#pragma once

#include <cstdint>
#include <vector>

#include "base/vec.h"
#include "geometry/object.h"
#include "geometry/rays.h"
#include "scene/scene.h"

namespace searchlight {

/// A pinhole camera placed in mm. Pixel (0, 0) is at the top left; the image plane is at distance 1.
struct View {
    int width = 0, height = 0;
    Vec3 eye;
    Vec3 right, up, forward;  ///< orthonormal
    double tan_half = 0;      ///< of the vertical field of view

    /// Through the picture's point (x, y) in pixels; not normalised: forward component 1.
    Vec3 direction(double x, double y) const {
        const double pixel = 2 * tan_half / height;
        return forward + (pixel * (x - 0.5 * width)) * right + (pixel * (0.5 * height - y)) * up;
    }
};

/// The scene's camera around an object of that longest side.
View makeView(const Camera& camera, double longest_mm, int width, int height);

/// The surface samples behind the pixels, listed tile by tile (8 x 8 pixels), so that neighbours in the list are
/// neighbours in space. A pixel has one sample or, with antialiasing at edges, several.
struct VisibleSurface {
    int width = 0, height = 0;
    std::vector<std::uint32_t> pixels;  ///< y * width + x, per sample
    std::vector<float> coverage;        ///< of its pixel, per sample; a pixel's add up to at most 1
    std::vector<Vec3f> positions;       ///< mm, on the triangle
    std::vector<Vec3f> normals;         ///< for shading: interpolated, unit
    std::vector<Vec3f> geometric_normals;
};

}  // namespace searchlight
