// The filter of screen_filter.h on OpenGL.
#pragma once

#include <span>
#include <vector>

#include "gl/buffer.h"
#include "gl/program.h"
#include "render/screen/screen_filter.h"

namespace searchlight {

/// Samples on a device. Two passes of a compute program per term, each in slices between which it can be cancelled.
class ScreenFilterGl {
public:
    /// The context outlives it.
    explicit ScreenFilterGl(gl::Context& context);

    /// Copies what the passes read. `samples` outlive them.
    void setSamples(const ScreenSamples& samples);

    /// filterScreen() for the samples that were set, within the rounding of single precision. Throws a device Error as
    /// gl::Program does, interruptedError() when cancelled.
    std::vector<Rgbf> filter(std::span<const Rgbf> light, const Taps& taps, const ScreenFilterOptions& options);

private:
    void dispatch(const ScreenFilterOptions& options, const gl::Buffer& grid, const gl::Buffer& light,
                  const gl::Buffer& result, const gl::Buffer& grid_out);

    gl::Context& context_;
    gl::Program program_;
    gl::Buffer positions_, normals_, cells_, taps_;
    gl::Buffer grid_, grid_between_, light_, between_, sums_;
    const ScreenSamples* samples_ = nullptr;
    // Positions with strength; normals with turns; the grid without light.
    std::vector<std::array<float, 4>> places_, normals_of_, texels_;
    std::vector<std::uint32_t> source_, cell_;  // as in ScreenSamples
    std::size_t count_ = 0;
};

}  // namespace searchlight
