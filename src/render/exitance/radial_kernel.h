// R_d as a sum over points needs it: averaged over the disc that a point stands for, ending smoothly. In double.
#pragma once

#include <vector>

#include "model/profile.h"

namespace searchlight {

/// R_d averaged over a disc about the emitting point, as a function of w = r^2 + c^2, in which it is smooth at r = 0.
class RadialKernel {
public:
    /// Nodes per octave of w. They stand evenly inside an octave, as the mantissas of floats do.
    static constexpr int nodes_per_octave = 64;

    RadialKernel(const Profile& profile, double cell_area_mm2);

    double offset() const { return offset_; }  ///< c^2: a power of two, about (disc radius / 4)^2
    std::size_t octaves() const { return octaves_; }

    /// w of node k, 0 <= k <= nodes_per_octave * octaves().
    double node(std::size_t k) const;
    const std::vector<Rgb>& values() const { return values_; }  ///< at the nodes; the last is 0

    /// Interpolated with a relative error of about 1e-7 where the profile itself is smooth.
    Rgb operator()(double r_mm) const;

    Rgb total() const { return total_; }  ///< of the profile
    /// Mean of r^2 weighted with |R_d| over the plane, mm^2; 0 for a channel without R_d.
    Rgb meanSquareRadius() const { return mean_square_radius_; }

private:
    double offset_;
    std::size_t octaves_;
    std::vector<Rgb> values_;
    Rgb total_, mean_square_radius_;
};

}  // namespace searchlight
