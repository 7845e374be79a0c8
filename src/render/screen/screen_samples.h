// The visible surface as filters of the picture read it: samples in camera coordinates, and who stands for a pixel.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "base/vec.h"
#include "render/view.h"

namespace searchlight {

/// Samples in the order of VisibleSurface, plane by plane, each padded to whole vectors by copies of the last one. In
/// camera coordinates x points right, y down and z forward, so that (x, y, z) mm is seen at pixel
/// (width / 2 + focal x / z, height / 2 + focal y / z).
struct ScreenSamples {
    static constexpr std::size_t lanes = 16;
    static constexpr std::uint32_t nothing = std::numeric_limits<std::uint32_t>::max();

    int width = 0, height = 0;
    float focal = 0;  ///< pixels: half the height over the tangent of half the vertical field of view, Eq. 4.11
    std::size_t count = 0;
    std::array<std::vector<float>, 3> position;  ///< mm
    std::array<std::vector<float>, 3> normal;    ///< unit, towards the eye
    /// Where the sample stands in a grid if it stands for its pixel, as the one with the largest coverage; else
    /// nothing.
    std::vector<std::uint32_t> cell;
    std::vector<float> depth;  ///< grid: z of who stands for the pixel, mm; 0: nothing is seen there

    /// A grid holds a pixel more on every side, in which nothing is seen.
    int stride() const { return width + 2; }
    std::size_t cells() const { return static_cast<std::size_t>(stride()) * static_cast<std::size_t>(height + 2); }
    std::size_t padded() const { return (count + lanes - 1) / lanes * lanes; }
};

/// Samples of what `view` sees, which `visible` was made with. The order and the result do not depend on `threads`.
ScreenSamples screenSamples(const View& view, const VisibleSurface& visible, int threads);

}  // namespace searchlight
