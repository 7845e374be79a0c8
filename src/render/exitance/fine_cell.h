// For sums over random points, which stand for no area of their own.
#pragma once

#include "model/profile.h"

namespace searchlight {

/// A cell for a RadialTable that has no size to speak of: it holds 1e-4 of the flux of the densest channel, so that
/// nothing is seen of the mean over it, and no distance of two floats is 0. mm^2.
double fineCellArea(const Profile& profile);

}  // namespace searchlight
