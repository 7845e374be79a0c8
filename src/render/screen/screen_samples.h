// The visible surface as filters of the picture read it: samples in camera coordinates, and who stands for a pixel.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/vec.h"
#include "render/view.h"

namespace searchlight {

/// Samples in strips of columns, row by row, those that stand for their pixel first, plane by plane, each padded to
/// whole vectors by copies of the last one. In camera coordinates x points right, y down and z forward, so that (x, y,
/// z) mm is seen at pixel (width / 2 + focal x / z, height / 2 + focal y / z).
struct ScreenSamples {
    static constexpr std::size_t lanes = 16;
    /// Vectors are read from so far before the first cell of a grid to so far behind the last one.
    static constexpr int margin = 64;
    /// Columns of a strip: what a pass across the rows reads over 300 of them, 1.2 MB, stays in a core's own cache.
    static constexpr std::size_t strip = 256;

    int width = 0, height = 0;
    float focal = 0;  ///< pixels: half the height over the tangent of half the vertical field of view, Eq. 4.11
    std::size_t count = 0, standing = 0;         ///< samples; those of them that stand for a pixel
    std::vector<std::uint32_t> source;           ///< place in the VisibleSurface
    std::array<std::vector<float>, 3> position;  ///< mm
    std::array<std::vector<float>, 3> normal;    ///< unit, towards the eye
    std::vector<std::uint32_t> cell;             ///< where in a grid who stands for a pixel stands
    std::vector<float> depth;                    ///< grid: z of who stands there, mm; 0: nothing is seen

    /// A grid holds a pixel more on every side, in which nothing is seen: (0, 0) stands at margin + stride() + 1.
    int stride() const { return width + 2; }
    std::size_t cells() const {
        return static_cast<std::size_t>(stride()) * static_cast<std::size_t>(height + 2) + 2 * margin;
    }
    std::size_t padded() const { return (count + lanes - 1) / lanes * lanes; }
};

/// Samples of what `view` sees, which `visible` was made with. Of several in a pixel the one with the largest coverage
/// stands for it. The result does not depend on `threads`.
ScreenSamples screenSamples(const View& view, const VisibleSurface& visible, int threads);

}  // namespace searchlight
