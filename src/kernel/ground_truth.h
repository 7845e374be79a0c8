// The kernel that all others stand in for: R_d of a profile, turned about the normal and normalised.
#pragma once

#include "base/vec.h"
#include "model/profile.h"

namespace searchlight {

/// R_d per unit of its own total, per channel: what is left of energy is a factor of the albedo, outside of kernels.
class GroundTruth {
public:
    /// Throws an input Error where the profile is empty, or negative in total. A channel whose total is 0 does not
    /// scatter: its kernel is a delta. `tail` is the fraction of energy beyond the profile's last radius, stated.
    explicit GroundTruth(Profile profile, double tail = 0);

    /// Fraction of energy within r of the axis.
    Rgb encircled(double r_mm) const;
    /// Density on the plane, 1/mm^2, integral 1.
    Rgb operator()(double r_mm) const;
    /// Radius that holds that fraction, in (0, 1), of one channel's energy.
    double radiusOf(double fraction, int channel) const { return profile_.sampleRadius(fraction, channel); }

    bool scatters(int channel) const { return total_[channel] > 0; }
    double extent() const { return profile_.radii().back(); }
    double tail() const { return tail_; }
    const Profile& profile() const { return profile_; }
    Rgb total() const { return total_; }  ///< what was divided by

private:
    Profile profile_;
    Rgb total_, factor_;
    double tail_ = 0;
};

}  // namespace searchlight
