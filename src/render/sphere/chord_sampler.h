// Points around a point of a sphere, as far away as a profile says.
#pragma once

#include "base/vec.h"
#include "model/profile.h"
#include "scene/medium.h"

namespace searchlight {

/// Draws points of a sphere by their distance, measured straight through it, in proportion to |R_d| of a channel that
/// is chosen evenly among those that scatter. The part of a sphere's surface within distance r of a point of it is
/// pi r^2, as on a plane, so that the profile's own distribution, cut off at the diameter, is the right one
/// without any weight. Immutable.
class ChordSampler {
public:
    ChordSampler(const Profile& profile, const Medium& medium, double radius_mm);

    /// False where the profile is 0 within the diameter: then there is nothing to sample.
    bool usable() const { return channel_count_ > 0; }

    /// Around `from` (a direction from the centre) for three uniform numbers in [0, 1): a direction. Requires usable().
    Vec3 sample(Vec3 from, double u_channel, double u, double v) const;

    /// The density of sample() at that distance, per mm^2.
    double density(double r_mm) const;

private:
    Profile profile_;
    double radius_mm_;
    int channels_[Rgb::channels] = {};
    int channel_count_ = 0;
    Rgb within_;  ///< of the profile's flux, inside the diameter
    Rgb total_;
    Rgb nearest_;  ///< inside the profile's first radius
};

}  // namespace searchlight
