// A tabulated radial profile R_d(r) with its cumulative distribution: what kernels, radius sampling, textures and plots
// share.
#pragma once

#include <span>
#include <vector>

#include "base/vec.h"

namespace searchlight {

/// Radii in mm, ascending; values in 1/mm^2 per unit flux that has crossed into the medium. Between the samples a cubic
/// that has no extremum of its own, so that a profile without negative samples is nowhere negative; below the first
/// radius the first value, beyond the last 0. All integrals are exact for that curve.
class Profile {
public:
    Profile() = default;

    /// From samples: at least 2 radii, ascending, finite, the first >= 0. Throws an input Error otherwise.
    Profile(std::vector<double> radii_mm, std::vector<Rgb> values);

    bool empty() const { return radii_mm_.empty(); }
    std::span<const double> radii() const { return radii_mm_; }
    std::span<const Rgb> values() const { return values_; }

    /// Interpolated R_d at r >= 0; 0 beyond the last radius; the first value below the first radius.
    Rgb operator()(double r_mm) const;

    /// Integral of 2 pi r R_d over [0, r].
    Rgb encircled(double r_mm) const;

    /// Integral over the tabulated disc.
    Rgb total() const;

    /// Mean of R_d over the annulus [r0, r1], r0 < r1.
    Rgb annulusMean(double r0_mm, double r1_mm) const;

    /// Radius at which the encircled fraction reaches u in [0, 1), for one channel: importance sampling of 2 pi r R_d.
    /// Requires a profile that is nowhere negative, and somewhere positive, in that channel.
    double sampleRadius(double u, int channel) const;

private:
    double encircledIn(std::size_t interval, double r_mm, int channel) const;

    std::vector<double> radii_mm_;
    std::vector<Rgb> values_;
    std::vector<Rgb> slopes_;      // dR_d/dr at the samples
    std::vector<Rgb> cumulative_;  // encircled up to each sample
};

}  // namespace searchlight
