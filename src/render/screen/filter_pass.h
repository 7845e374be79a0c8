// One pass of a separable kernel over the visible surface: what the CPU's lanes and the device's program share.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "base/vec.h"
#include "kernel/kernel.h"
#include "render/screen/screen_filter.h"

namespace searchlight {

/// On both sides of the middle: kernels are even.
struct FilterTap {
    float offset = 0;  ///< mm, above 0
    Rgbf weight;       ///< of each side
};

/// Along cosine u + sine v, u and v being the axes of FilterAxes, u within the picture's row.
struct FilterLine {
    float cosine = 1, sine = 0;
    Rgbf middle;  ///< weight of the sample itself
    std::vector<FilterTap> taps;

    enum class Course { row, column, any };
    /// Where the pass stays: there two pixels answer for a tap, elsewhere four.
    Course course(FilterAxes axes) const;
};

/// The two passes of a term, and its factor.
struct FilterTerm {
    std::array<FilterLine, 2> lines;
    Rgbf scale;
};

std::vector<FilterTerm> filterTerms(const Taps& taps);

/// cos and sin per sample, padded: by what the axes turn in the pixel that it is seen in.
std::array<std::vector<float>, 2> filterTurns(const ScreenSamples& samples, int frame, bool second);

/// 1 / (reach meanOffset() width), 1/mm, at most 1e12.
float perReach(const Taps& taps, const ScreenFilterOptions& options);

struct FilterPass {
    /// Squared sine between the planes of row and surface, below which the surface is seen from its edge.
    static constexpr float edge_on = 1e-6f;
    /// A tap is nowhere nearer to the eye than this part of the sample's depth.
    static constexpr float nearest = 0.1f;

    const ScreenSamples* samples = nullptr;
    const FilterLine* line = nullptr;
    FilterLine::Course course = FilterLine::Course::any;
    FilterAxes axes = FilterAxes::surface;
    FilterTrust trust = FilterTrust::distance;
    float width = 1, per_reach = 0, fallback = 1;
    std::span<const float> strength;      ///< padded, or empty
    std::array<const float*, 2> turns{};  ///< filterTurns(), or null
    std::array<const float*, 3> grid{};   ///< light of who stands for the cell, per channel
    std::array<const float*, 3> light{};
    std::array<float*, 3> result{};    ///< per sample
    std::array<float*, 3> grid_out{};  ///< the same of who stands for the cell; or null
};

}  // namespace searchlight
