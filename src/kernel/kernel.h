// Separable kernels: what a shader blurs diffuse light with instead of R_d on the plane.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "base/vec.h"
#include "kernel/line_kernel.h"

namespace searchlight {

/// scale a(u) a(v) per channel: a pass along u, a pass along v, and a factor that may be negative (a singular vector
/// with a negative eigenvalue).
struct KernelTerm {
    double angle_deg = 0;  ///< of u against x; v stands at right angles to u
    Rgb scale{1, 1, 1};
    std::array<LineKernel, Rgb::channels> lines;

    /// Integral over the plane, per channel.
    Rgb mass() const;
};

/// A sum of terms. One term is two passes.
struct SeparableKernel {
    std::string method;  ///< "preintegrated", "svd"...
    std::vector<KernelTerm> terms;
    double extent_mm = 0;  ///< beyond this distance along an axis every line is 0

    std::size_t rank() const { return terms.size(); }

    /// Density at a point of the plane, 1/mm^2, without the deltas.
    Rgb operator()(double x_mm, double y_mm) const;

    /// Integral over the plane, per channel: 1 for a kernel that keeps energy.
    Rgb mass() const;
};

/// One term as samples: the pass is delta E(x) + sum of weights[i] E(x + width offsets[i]), where width, 1 at true
/// scale, is chosen at run time. The weights and the delta of a term of rank 1 add up to 1 in each channel.
struct TapTerm {
    double angle_deg = 0;
    Rgb scale{1, 1, 1};
    std::vector<double> offsets_mm;  ///< ascending, symmetric about the middle one, which is 0; an odd count
    std::vector<Rgb> weights;        ///< as many, without the delta
    Rgb delta;                       ///< unmoved light: added to the middle, never widened

    /// Integral over the plane, per channel.
    Rgb mass() const;
    /// Of the tap at `i`, with the delta where it is the middle one: what a table in a shader holds.
    Rgb weight(std::size_t i) const;
};

struct Taps {
    std::vector<TapTerm> terms;
    double extent_mm = 0;  ///< largest offset
    bool turned = false;   ///< made for axes that turn from pixel to pixel

    std::size_t rank() const { return terms.size(); }
    Rgb mass() const;
};

}  // namespace searchlight
