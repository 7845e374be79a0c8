// R_d as a shader reads it, and how far an expansion of it may reach.
#pragma once

#include <array>
#include <vector>

#include "render/exitance/radial_kernel.h"

namespace searchlight {

/// A kernel over w = r^2 + c^2, an entry per interval between its nodes, found by the bits of w as a float. An entry is
/// three texels, at the middle of its interval: R and the reach; dR/dw; d2R/dw2. The last entry is all zero but for its
/// reach.
///
/// The reach s(r) belongs to an error of 1: an expansion of second order about two points r apart may be used up to
/// cbrt(error) s(r) from them. It bounds the term of third order, in every channel, by the error times R_d(r) plus mean
/// R_d; the mean keeps light from being followed to where there is hardly any.
struct RadialTableGl {
    /// Bits of the mantissa that count.
    static constexpr int bits = 6;
    static_assert(1 << bits == RadialKernel::nodes_per_octave);

    double offset = 0;  ///< c^2, mm^2: a power of two
    std::vector<std::array<float, 4>> texels;

    int entries() const { return static_cast<int>(texels.size() / 3); }
    int firstBits() const;  ///< the bits of `offset` that count: those of entry 0

    /// The reach at w = r^2 + c^2, as shaders find it.
    float reach(float w) const;
};

/// `area_mm2`: of the whole surface, over which a profile that reaches beyond it has its mean.
RadialTableGl makeRadialTableGl(const RadialKernel& kernel, double area_mm2);

}  // namespace searchlight
