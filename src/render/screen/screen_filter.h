// A separable kernel over the visible surface: what the filter of a picture does with the light at its pixels.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/observer.h"
#include "base/vec.h"
#include "kernel/kernel.h"
#include "render/screen/screen_samples.h"

namespace searchlight {

/// Along what a pass steps.
enum class FilterAxes : std::uint8_t {
    screen,   ///< the picture's axes, by depth and field of view alone [Freude2014, Eq. 4.11]
    surface,  ///< two directions at right angles in the tangent plane, projected: mm on the surface, however it is
              ///< tilted
    turned,   ///< those, turned within the plane from pixel to pixel, turnOfPixel(): crosses become grain
};

/// What is made of a tap whose pixel shows something else than the plane on which the tap lies, by its height h over
/// that plane (the one through the sample that faces the camera, or the tangent plane).
enum class FilterTrust : std::uint8_t {
    all,    ///< taken as it is
    depth,  ///< replaced by the middle in proportion to h, as a whole from `reach` on [Freude2014, Eq. 4.12]
    /// Replaced by the middle as an exponential falls over the way that it is further than the plane: about
    /// (o^2 + h^2)^1/2 - o at offset o.
    distance,
};

struct ScreenFilterOptions {
    FilterAxes axes = FilterAxes::surface;
    FilterTrust trust = FilterTrust::distance;
    double width = 1;  ///< times the offsets of the taps
    /// In multiples of the kernel's mean |offset|: from where on nothing is trusted, or how far the kernel falls by e.
    double reach = 1;
    /// What stands for light that is not trusted, not seen or outside the picture: so much of the middle's.
    double fallback = 1;
    int frame = 0;                    ///< of axes that turn: another pattern for each
    std::span<const float> strength;  ///< times `width`, per sample; empty: 1 everywhere
    int threads = 0;                  ///< 0: all
    Observer* observer = nullptr;     ///< asked between rows of work whether to stop: interruptedError()
};

/// Mean |offset| of the lines of the first term, over its channels and weights, mm: the length by which trust is
/// measured. 0 for a kernel that moves nothing.
double meanOffset(const Taps& taps);

/// Filters pictures, one at a time, and keeps its memory from one to the next.
class ScreenFilter {
public:
    using Planes = std::array<std::vector<float>, 3>;

    /// `light` (per sample of the VisibleSurface, any unit) filtered by every term of `taps` in two passes each and
    /// added up: the sum over the taps of weight times the light at the pixel that the tap falls on, bilinear. Samples
    /// of a pixel that others stand for read the same grid and themselves in the middle. With a fallback
    /// of 1 even light stays as it is. The result does
    /// not depend on `threads`.
    void filter(const ScreenSamples& samples, std::span<const Rgbf> light, const Taps& taps,
                const ScreenFilterOptions& options, std::vector<Rgbf>& result);

private:
    Planes given_, between_, filtered_;  // per sample
    Planes grid_, grid_between_;
    std::vector<float> strength_;
    std::array<std::array<std::vector<float>, 2>, 2> turns_;  // of both passes: cos and sin
};

/// The same once.
std::vector<Rgbf> filterScreen(const ScreenSamples& samples, std::span<const Rgbf> light, const Taps& taps,
                               const ScreenFilterOptions& options);

}  // namespace searchlight
