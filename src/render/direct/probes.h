// Surface points around a receiver by the profile's own distribution: a disc, projected along three axes [King2013].
#pragma once

#include <array>

#include "base/vec.h"
#include "geometry/rays.h"
#include "model/profile.h"
#include "scene/medium.h"

namespace searchlight {

/// A receiver's axes: its normal and two across, unit.
struct ProbeFrame {
    std::array<Vec3, 3> axes;
    explicit ProbeFrame(Vec3 normal);
};

/// The distribution of the distance: the mean over channels of |R_d| over its total, per mm^2. Immutable.
class Probes {
public:
    /// Channels that do not scatter, or have no R_d, are left out.
    Probes(const Profile& profile, const Medium& medium);

    /// False where there is nothing to sample.
    bool usable() const { return channel_count_ > 0; }
    double reach() const { return profile_.radii().back(); }  ///< mm: beyond, nothing is found

    /// The density at that distance in the plane of a disc, per mm^2.
    double disc(double r_mm) const;

    /// A line through the sphere of reach() about `from`, along an axis of its frame, for two uniform numbers in
    /// [0, 1): every surface that it meets from its origin to t_max is a sample. Requires usable().
    Ray sample(Vec3 from, const ProbeFrame& frame, double u, double v) const;

    /// The expected number of samples per mm^2 of surface at `offset` from the receiver, within reach(), whose
    /// geometric normal is `normal`: over all three axes, so that it does not matter along which one it was found.
    double density(Vec3 offset, Vec3 normal, const ProbeFrame& frame) const;

private:
    Profile profile_;  ///< without sign
    Rgb total_;
    std::array<int, Rgb::channels> channels_{};
    int channel_count_ = 0;
};

}  // namespace searchlight
